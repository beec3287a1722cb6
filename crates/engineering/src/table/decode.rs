//! Decoding of bytes to text.

use super::error::ForeignFile;
use crate::project::Findings;

/// First bytes of files that are not tables of text.
const OTHERS: [(&[u8], ForeignFile); 7] = [
    (b"PK\x03\x04", ForeignFile::Archive),
    (b"\xd0\xcf\x11\xe0", ForeignFile::OldSpreadsheet),
    (b"\x1f\x8b", ForeignFile::Compressed),
    (b"MATLAB 5.0", ForeignFile::Matlab),
    (b"\x89HDF", ForeignFile::Hdf5),
    (b"TDSm", ForeignFile::Labview),
    (b"%PDF", ForeignFile::Document),
];

/// Text of a file, and number of bytes before it. Encodings other than UTF-8 are those that
/// spreadsheets write: UTF-16 with its mark, and one byte for each sign (ISO 8859-1).
pub(super) fn text(file: &str, mut bytes: Vec<u8>, findings: &mut Findings) -> Option<(String, usize)> {
    if let Some((_, what)) = OTHERS.iter().find(|(start, _)| bytes.starts_with(start)) {
        findings.unreadable(file, &what.to_string());
        return None;
    }
    let (found, skipped) = if bytes.starts_with(b"\xff\xfe") {
        (wide(&bytes, u16::from_le_bytes), 2)
    } else if bytes.starts_with(b"\xfe\xff") {
        (wide(&bytes, u16::from_be_bytes), 2)
    } else if bytes.starts_with(b"\xef\xbb\xbf") {
        bytes.drain(..3);
        (Some(narrow(bytes)), 3)
    } else {
        (Some(narrow(bytes)), 0)
    };
    let is_text = |content: &String| !content.bytes().take(MOST_EVALUATED).any(is_control);
    let Some(content) = found.filter(is_text) else {
        findings.unreadable(file, &ForeignFile::NotText.to_string());
        return None;
    };
    // lines may end as on old systems
    let is_old = content.contains('\r') && !content.contains('\n');
    Some((if is_old { content.replace('\r', "\n") } else { content }, skipped))
}

/// Text in UTF-16 after its mark.
fn wide(bytes: &[u8], order: fn([u8; 2]) -> u16) -> Option<String> {
    let pairs = bytes.get(2..)?.chunks_exact(2);
    let units: Vec<u16> = pairs.filter_map(|pair| pair.try_into().ok()).map(order).collect();
    String::from_utf16(&units).ok()
}

/// Length of the part of a text that is checked for signs that do not occur in text.
const MOST_EVALUATED: usize = 4096;

fn is_control(byte: u8) -> bool {
    byte < 0x20 && !matches!(byte, b'\t' | b'\n' | b'\r' | 0x0c | 0x1a)
}

/// Text in UTF-8, or with one byte for each sign.
fn narrow(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes)
        .unwrap_or_else(|error| error.as_bytes().iter().map(|byte| char::from(*byte)).collect())
}
