//! Files of TwinCAT.

use super::FunctionBlock;

/// A function block as a file of TwinCAT 3, with an identifier that depends on the project alone.
pub(super) fn file(block: &FunctionBlock, head: &str, project_sha256: &str) -> String {
    let FunctionBlock { name, declaration, statements } = block;
    format!(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>
<TcPlcObject Version=\"1.1.0.1\" ProductVersion=\"3.1.4024.0\">
  <POU Name=\"{name}\" Id=\"{{{}}}\" SpecialFunc=\"None\">
    <Declaration><![CDATA[{head}
{declaration}]]></Declaration>
    <Implementation>
      <ST><![CDATA[{statements}]]></ST>
    </Implementation>
  </POU>
</TcPlcObject>
",
        identifier(project_sha256, name)
    )
}

/// Digits of the sum of a project, with those of a name added, as an identifier of an object.
fn identifier(project_sha256: &str, name: &str) -> String {
    let digits: Vec<u32> = project_sha256.chars().filter_map(|digit| digit.to_digit(16)).collect();
    let mut mixed = [0_u32; 32];
    let letters = name.bytes().map(u32::from);
    for (place, value) in digits.into_iter().chain(letters).enumerate() {
        let digit = &mut mixed[place % 32];
        *digit = (*digit * 7 + value) % 16;
    }
    let text: String = mixed.iter().filter_map(|digit| char::from_digit(*digit, 16)).collect();
    let parts = [0..8, 8..12, 12..16, 16..20, 20..32];
    parts.map(|part| text.get(part).unwrap_or_default().to_string()).join("-")
}
