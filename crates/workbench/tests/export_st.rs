//! Exported Structured Text gives the bits of the simulation, by a walker of its syntax tree.

use std::collections::HashMap;

use iec61131::{
    Argument, BinaryOp, Expression, FunctionBlockDecl, Literal, Parser, PouDeclaration, Statement, TypeSpec,
    UnaryOp, VarDecl, Variable,
};
use phea_dynamics::controller::{AntiWindup, Compensator, Controller, Element};
use phea_machine::Deployed;
use phea_workbench::export::ExportKind;

use crate::exported::{commands, drawn, exported, samples};

/// A value of a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Value {
    Real(f64),
    Whole(i64),
    Truth(bool),
}

/// An instance of a function block: its variables, and the instances inside.
#[derive(Clone, Debug, Default)]
struct Instance {
    block: String,
    variables: HashMap<String, Value>,
    inside: HashMap<String, Instance>,
}

type Blocks = HashMap<String, FunctionBlockDecl>;
type Outcome<T> = Result<T, String>;

/// The function blocks of a text.
fn blocks(text: &str) -> Outcome<Blocks> {
    let unit = Parser::new(text).parse().map_err(|error| error.to_string())?;
    let named = |declaration| match declaration {
        PouDeclaration::FunctionBlock(block) => Ok((block.name.clone(), block)),
        other => Err(format!("{other:?}")),
    };
    unit.declarations.into_iter().map(named).collect()
}

fn instance(blocks: &Blocks, name: &str) -> Outcome<Instance> {
    let block = blocks.get(name).ok_or(format!("no block {name}"))?;
    let mut made = Instance { block: name.to_string(), ..Instance::default() };
    for variable in block.inputs.iter().chain(&block.outputs).chain(&block.vars) {
        declare(blocks, &mut made, variable)?;
    }
    Ok(made)
}

fn declare(blocks: &Blocks, made: &mut Instance, variable: &VarDecl) -> Outcome<()> {
    let value = match &variable.var_type {
        TypeSpec::Elementary(kind) if kind == "LREAL" => Value::Real(0.0),
        TypeSpec::Elementary(kind) if kind == "DINT" => Value::Whole(0),
        TypeSpec::Elementary(kind) if kind == "BOOL" => Value::Truth(false),
        // the parser does not know which names are blocks
        TypeSpec::Elementary(kind) if blocks.contains_key(kind) => {
            made.inside.insert(variable.name.clone(), instance(blocks, kind)?);
            return Ok(());
        }
        other => return Err(format!("{}: {other:?}", variable.name)),
    };
    let fresh = made.variables.insert(variable.name.clone(), value).is_none();
    fresh.then_some(()).ok_or(format!("{} is declared twice", variable.name))?;
    variable.init_value.iter().try_for_each(|start| {
        let start = made.value(start)?;
        made.assign(&variable.name, start)
    })
}

impl Instance {
    fn assign(&mut self, name: &str, value: Value) -> Outcome<()> {
        let place = self.variables.get_mut(name).ok_or(format!("{name} is not declared"))?;
        if std::mem::discriminant(place) != std::mem::discriminant(&value) {
            return Err(format!("{name} is {place:?}, not {value:?}"));
        }
        *place = value;
        Ok(())
    }

    fn real(&self, name: &str) -> f64 {
        match self.variables[name] {
            Value::Real(value) => value,
            other => panic!("{name} is {other:?}"),
        }
    }

    /// One call of the block.
    fn call(&mut self, blocks: &Blocks) -> Outcome<()> {
        let body = blocks[&self.block].body.as_ref().ok_or("no body")?;
        match body.first().filter(|first| self.is_left_at_once(first)) {
            Some(_) => Ok(()),
            None => self.run(blocks, body),
        }
    }

    fn run(&mut self, blocks: &Blocks, body: &[Statement]) -> Outcome<()> {
        body.iter().try_for_each(|statement| self.execute(blocks, statement))
    }

    fn is_left_at_once(&self, statement: &Statement) -> bool {
        let Statement::If { condition, then_body, .. } = statement else { return false };
        matches!(then_body.as_slice(), [Statement::Return { .. }])
            && self.value(condition) == Ok(Value::Truth(true))
    }

    fn execute(&mut self, blocks: &Blocks, statement: &Statement) -> Outcome<()> {
        match statement {
            Statement::Assignment { target: Variable::Simple(name), value, .. } => {
                expect_one_operation(value)?;
                let value = self.value(value)?;
                self.assign(name, value)
            }
            Statement::If { condition, then_body, elsif_parts, else_body, .. } if elsif_parts.is_empty() => {
                match (self.value(condition)?, else_body) {
                    (Value::Truth(true), _) => self.run(blocks, then_body),
                    (Value::Truth(false), Some(body)) => self.run(blocks, body),
                    (Value::Truth(false), None) => Ok(()),
                    (other, _) => Err(format!("a condition is {other:?}")),
                }
            }
            Statement::FbInvocation { instance: name, arguments, .. }
            | Statement::FunctionCall { name, arguments, .. } => self.invoke(blocks, name, arguments),
            other => Err(format!("{other:?}")),
        }
    }

    fn invoke(&mut self, blocks: &Blocks, name: &str, arguments: &[Argument]) -> Outcome<()> {
        let mut called = self.inside.remove(name).ok_or(format!("no instance {name}"))?;
        for argument in arguments {
            let Argument::Named { name, value } = argument else { return Err(format!("{argument:?}")) };
            called.assign(name, self.value(value)?)?;
        }
        called.call(blocks)?;
        self.inside.insert(name.to_string(), called);
        Ok(())
    }

    fn value(&self, expression: &Expression) -> Outcome<Value> {
        match expression {
            Expression::Literal(Literal::Real(value)) => Ok(Value::Real(*value)),
            Expression::Literal(Literal::Integer(value)) => Ok(Value::Whole(*value)),
            Expression::Literal(Literal::Bool(value)) => Ok(Value::Truth(*value)),
            Expression::Parenthesized(inside) => self.value(inside),
            Expression::Variable(Variable::Simple(name)) => {
                self.variables.get(name).copied().ok_or(format!("{name} is not declared"))
            }
            Expression::Variable(Variable::MemberAccess { base, member }) => match &**base {
                Variable::Simple(name) => {
                    let inside = self.inside.get(name).ok_or(format!("no instance {name}"))?;
                    inside.variables.get(member).copied().ok_or(format!("{member} is not declared"))
                }
                other => Err(format!("{other:?}")),
            },
            Expression::Unary { op, operand } => match (op, self.value(operand)?) {
                (UnaryOp::Neg, Value::Real(value)) => Ok(Value::Real(-value)),
                (UnaryOp::Not, Value::Truth(value)) => Ok(Value::Truth(!value)),
                (op, value) => Err(format!("{op:?} {value:?}")),
            },
            Expression::Binary { op, left, right } => binary(*op, self.value(left)?, self.value(right)?),
            other => Err(format!("{other:?}")),
        }
    }
}

fn binary(operator: BinaryOp, left: Value, right: Value) -> Outcome<Value> {
    use BinaryOp::{Add, And, Div, Ge, Gt, Le, Lt, Mul, Ne, Or, Sub};
    let found = match (operator, left, right) {
        (Add, Value::Real(one), Value::Real(other)) => Value::Real(one + other),
        (Sub, Value::Real(one), Value::Real(other)) => Value::Real(one - other),
        (Mul, Value::Real(one), Value::Real(other)) => Value::Real(one * other),
        (Div, Value::Real(one), Value::Real(other)) => Value::Real(one / other),
        (Add, Value::Whole(one), Value::Whole(other)) => Value::Whole(one + other),
        (Lt, Value::Real(one), Value::Real(other)) => Value::Truth(one < other),
        (Le, Value::Real(one), Value::Real(other)) => Value::Truth(one <= other),
        (Gt, Value::Real(one), Value::Real(other)) => Value::Truth(one > other),
        (Ge, Value::Real(one), Value::Real(other)) => Value::Truth(one >= other),
        (Ne, one, other) => Value::Truth(one != other),
        (And, Value::Truth(one), Value::Truth(other)) => Value::Truth(one && other),
        (Or, Value::Truth(one), Value::Truth(other)) => Value::Truth(one || other),
        (operator, one, other) => return Err(format!("{one:?} {operator:?} {other:?}")),
    };
    Ok(found)
}

/// A statement that assigns a number has at most one operation, so that it rounds once.
fn expect_one_operation(value: &Expression) -> Outcome<()> {
    fn operations(value: &Expression) -> usize {
        match value {
            Expression::Binary { op, left, right } => {
                let arithmetic = matches!(op, BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul | BinaryOp::Div);
                usize::from(arithmetic) + operations(left) + operations(right)
            }
            Expression::Unary { operand, .. } => operations(operand),
            Expression::Parenthesized(inside) => operations(inside),
            Expression::Call { .. } => 2,
            _ => 0,
        }
    }
    (operations(value) <= 1).then_some(()).ok_or("more than one operation in a statement".to_string())
}

fn text_of(deployed: &Deployed) -> String {
    let files = ExportKind::StructuredText.files(&exported(deployed));
    let file = files.iter().find(|file| file.name == "rig.st").unwrap();
    String::from_utf8(file.bytes.clone()).unwrap()
}

/// Commands of the function block in a text for these samples.
fn walked(text: &str, samples: &[[f64; 4]]) -> Outcome<Vec<u64>> {
    let blocks = blocks(text)?;
    let mut controller = instance(&blocks, "rig")?;
    controller.assign("Enable", Value::Truth(true))?;
    let names = ["SetPoint", "Measured", "Velocity", "PressureSignal"];
    let inputs = &blocks["rig"].inputs;
    let read = names.map(|name| inputs.iter().any(|input| input.name == name));
    let mut commands = Vec::with_capacity(samples.len());
    for row in samples {
        for ((name, value), is_read) in names.iter().zip(row).zip(read) {
            if is_read {
                controller.assign(name, Value::Real(*value))?;
            }
        }
        controller.call(&blocks)?;
        commands.push(controller.real("Command").to_bits());
    }
    Ok(commands)
}

/// Number of outputs of the test vectors that differ.
fn differing(text: &str) -> Outcome<Value> {
    let blocks = blocks(text)?;
    let mut test = instance(&blocks, "rig_Test")?;
    test.assign("Run", Value::Truth(true))?;
    test.call(&blocks)?;
    Ok(test.variables["Differing"])
}

fn walks_to_the_bits(seeds: std::ops::Range<u64>, count: usize) {
    for seed in seeds {
        compare(&drawn(seed), count, seed);
    }
}

/// Compares the function block with the simulation, and runs its test vectors.
pub(crate) fn compare(deployed: &Deployed, count: usize, seed: u64) {
    let mut samples = samples(count, seed);
    samples[count / 2][0] = f64::NAN;
    samples[count / 3][1] = f64::INFINITY;
    let text = text_of(deployed);
    assert_eq!(walked(&text, &samples), Ok(commands(deployed, &samples)), "controller {seed}");
    assert_eq!(differing(&text), Ok(Value::Whole(0)), "test vectors of controller {seed}");
}

#[test]
fn exported_structured_text_gives_the_bits_of_the_simulation() {
    walks_to_the_bits(1..13, 2000);
}

#[test]
#[ignore = "part of the long tests"]
fn soak() {
    walks_to_the_bits(1..301, 100_000);
}

/// Each fault, in the statements of the controller, is found by the parser, by the declared types,
/// or by the test vectors.
#[test]
fn seeded_faults_are_found() {
    let poles = Element::ComplexPoles { natural_frequency: 300.0, damping_ratio: 0.4 };
    let controller = Controller {
        feedback: Compensator::new(vec![Element::Gain(1e-3), Element::Integrator, poles]),
        prefilter: Compensator::new(vec![Element::ComplexPoles {
            natural_frequency: 90.0,
            damping_ratio: 0.8,
        }]),
        command_limit: Some(5.0),
        anti_windup: AntiWindup::BackCalculation,
        ..Controller::default()
    };
    let text = text_of(&Deployed::new(controller.sampled(1e-3).unwrap()));
    assert_eq!(differing(&text), Ok(Value::Whole(0)));
    let faults = [
        ("SectionOutput := PartOne + Feedback1A", "SectionOutput := PartOne - Feedback1A"),
        ("ErrorValue := SignalValue -", "ErrorValue := SignalValue +"),
        ("PartOne := PartOne - PartTwo", "PartOne := PartTwo - PartOne"),
        ("SignalValue := SetPoint", "SignalValue := SetPiont"),
        ("SetPoint : LREAL", "SetPoint : BOOL"),
        ("SetPoint : LREAL", "SetPoint : REAL"),
        ("END_IF;", "END_IFF;"),
        ("IF Reset THEN", "IF Reset"),
        ("FUNCTION_BLOCK rig\n", "FUNCTION rig\n"),
        ("END_VAR", "END_VARS"),
        ("Feedback1B := PartOne;", "Feedback1B := PartTwo;"),
        ("Prefilter1A := PartOne + Prefilter1B", "Prefilter1A := PartOne + Feedback1B"),
        ("LastCommand := Unlimited;", "LastCommand := SectionOutput * 0.5;"),
        ("Limited := LastCommand <> Unlimited", "Limited := LastCommand = Unlimited"),
        ("Command := LastCommand;", "Command := Unlimited;"),
        ("SignalValue := ErrorValue;", "SignalValue := SetPoint;"),
        ("SectionOutput := PartOne +", "SectionOutput := PartOne * 1.0 +"),
        ("LREAL := 0.0;", "LREAL := FALSE;"),
        ("Enable : BOOL;", "Enabled : BOOL;"),
        ("SignalValue := SectionOutput;", "SectionOutput := SignalValue;"),
    ];
    for (right, wrong) in faults {
        assert!(text.contains(right), "{right}");
        let found = differing(&text.replacen(right, wrong, 1));
        let found_everywhere = differing(&text.replace(right, wrong));
        let is_found = |found: &Outcome<Value>| *found != Ok(Value::Whole(0));
        assert!(is_found(&found) || is_found(&found_everywhere), "{right} -> {wrong}");
    }
}
