//! The ports of a module, read from a rust-hdl block or from Verilog, so that nobody lists them by
//! hand.

use super::token::{Kind, Token, tokens};
use rust_hdl::prelude::{Atom, AtomKind, Block, Probe};

/// Which way a port points, seen from inside the module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Driven from outside.
    In,
    /// Driven by the module.
    Out,
    /// Driven by either side: a tri-state bus.
    InOut,
}

/// One port of a module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// Its name as the Verilog spells it.
    pub name: String,
    /// Bits, 1 to 32.
    pub width: u32,
    /// Which way it points.
    pub direction: Direction,
}

/// All ports of a module, in the order of its header.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ports {
    /// In the order of the module's header.
    pub list: Vec<Port>,
    /// Names of those inputs that are clocks.
    pub clocks: Vec<String>,
}

/// Why the ports could not be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PortError {
    /// The Verilog text declares no module of the name.
    #[error("no module `{module}` in the Verilog text; it has: {found}. Name one of these")]
    NoModule {
        /// The module that was asked for.
        module: String,
        /// The modules that are there.
        found: String,
    },
    /// A port that the harness cannot carry.
    #[error("port `{port}` of module `{module}`: {reason}")]
    Unsupported {
        /// Module whose header was read.
        module: String,
        /// Name in the Verilog.
        port: String,
        /// What is wrong, and what to do.
        reason: String,
    },
}

impl Ports {
    /// The ports of a rust-hdl block, named as `generate_verilog` names them; a port whose type is
    /// `Clock` is a clock.
    ///
    /// # Errors
    /// If a port is wider than 32 bits.
    pub fn of<B: Block>(block: &B) -> Result<Self, PortError> {
        let mut walk = Walk::default();
        block.accept("top", &mut walk);
        let ports = walk.ports;
        for port in &ports.list {
            check_width("top", &port.name, u64::from(port.width))?;
        }
        Ok(ports)
    }

    /// The ports of `module` in a Verilog text, in either header style; widths must be plain
    /// numbers. `clocks` names the clock inputs.
    ///
    /// # Errors
    /// If the module is not there, a width is not a plain number of 1 to 32 bits, or a clock is not
    /// a one-bit input.
    pub fn parse(verilog: &str, module: &str, clocks: &[&str]) -> Result<Self, PortError> {
        let all: Vec<Token> = tokens(verilog).into_iter().filter(|t| !t.is_blank()).collect();
        let modules = |t: &[Token]| t[0].is("module") && t[1].kind == Kind::Ident;
        let start = all.windows(2).position(|t| modules(t) && t[1].text == module);
        let Some(start) = start else {
            let found: Vec<_> = all.windows(2).filter(|t| modules(t)).map(|t| t[1].text).collect();
            let found = if found.is_empty() { "none".into() } else { found.join(", ") };
            return Err(PortError::NoModule { module: module.into(), found });
        };
        let body = &all[start + 2..];
        let end = body.iter().position(|t| t.is("endmodule")).unwrap_or(body.len());
        let list = declarations(module, &body[..end])?;
        for clock in clocks {
            let fits = |p: &Port| p.name == **clock && p.width == 1 && p.direction == Direction::In;
            if !list.iter().any(fits) {
                return Err(PortError::Unsupported {
                    module: module.into(),
                    port: (*clock).into(),
                    reason: "is not a one-bit input, so it cannot be a clock; correct the list of \
                             clocks"
                        .into(),
                });
            }
        }
        let clocks = clocks.iter().map(|c| (*c).to_owned()).collect();
        Ok(Self { list, clocks })
    }

    /// The inputs that are not clocks, in header order: the columns of a stimulus.
    pub fn inputs(&self) -> impl Iterator<Item = &Port> {
        let data = |p: &&Port| p.direction != Direction::Out && !self.clocks.contains(&p.name);
        self.list.iter().filter(data)
    }

    /// The outputs, in header order: the columns of a response.
    pub fn outputs(&self) -> impl Iterator<Item = &Port> {
        self.list.iter().filter(|p| p.direction != Direction::In)
    }

    /// The port called `name`, as Verilog spells it.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Port> {
        self.list.iter().find(|p| p.name == name)
    }
}

fn check_width(module: &str, port: &str, width: u64) -> Result<u32, PortError> {
    match u32::try_from(width) {
        Ok(width @ 1..=32) => Ok(width),
        _ => Err(PortError::Unsupported {
            module: module.into(),
            port: port.into(),
            reason: format!("is {width} bits wide; ports have 1 to 32 bits, so split it"),
        }),
    }
}

/// Walks the declarations of a header and a module body; both styles have the same shape.
fn declarations(module: &str, body: &[Token]) -> Result<Vec<Port>, PortError> {
    let mut ports: Vec<Port> = Vec::new();
    let mut direction = None;
    let mut width = 1;
    let mut at = 0;
    // Tasks and functions declare inputs of their own.
    let mut inside = false;
    while at < body.len() {
        let token = body[at];
        match token.text {
            "task" | "function" => inside = true,
            "endtask" | "endfunction" => inside = false,
            _ if inside => {}
            "input" => (direction, width) = (Some(Direction::In), 1),
            "output" => (direction, width) = (Some(Direction::Out), 1),
            "inout" => (direction, width) = (Some(Direction::InOut), 1),
            "wire" | "reg" | "signed" | "," | "(" => {}
            ";" | ")" => direction = None,
            "[" if direction.is_some() => {
                let close = body[at..].iter().position(|t| t.is("]")).map_or(body.len(), |n| at + n);
                let name = body.get(close + 1).map_or("?", |t| t.text);
                width = range(module, name, &body[at + 1..close])?;
                at = close;
            }
            name if token.kind == Kind::Ident => {
                if let Some(direction) = direction {
                    ports.push(Port { name: name.into(), width, direction });
                }
            }
            _ => {}
        }
        at += 1;
    }
    Ok(ports)
}

fn range(module: &str, port: &str, range: &[Token]) -> Result<u32, PortError> {
    let texts: Vec<_> = range.iter().map(|t| t.text).collect();
    match texts[..] {
        [high, ":", "0"] if high.parse::<u32>().is_ok() => {
            check_width(module, port, high.parse::<u64>().unwrap_or(u64::MAX).saturating_add(1))
        }
        _ => Err(PortError::Unsupported {
            module: module.into(),
            port: port.into(),
            reason: format!("has the range [{}]; write [number:0]", texts.concat()),
        }),
    }
}

#[derive(Default)]
struct Walk {
    depth: usize,
    namespace: Vec<String>,
    ports: Ports,
}

impl Probe for Walk {
    fn visit_start_scope(&mut self, _: &str, _: &dyn Block) {
        self.depth += 1;
    }

    fn visit_end_scope(&mut self, _: &str, _: &dyn Block) {
        self.depth -= 1;
    }

    fn visit_start_namespace(&mut self, name: &str, _: &dyn Block) {
        self.namespace.push(name.into());
    }

    fn visit_end_namespace(&mut self, _: &str, _: &dyn Block) {
        self.namespace.pop();
    }

    fn visit_atom(&mut self, name: &str, signal: &dyn Atom) {
        let direction = match signal.kind() {
            _ if self.depth != 1 => return,
            AtomKind::InputParameter => Direction::In,
            AtomKind::OutputParameter | AtomKind::OutputPassthrough => Direction::Out,
            AtomKind::InOutParameter => Direction::InOut,
            _ => return,
        };
        let mut path = self.namespace.clone();
        path.push(name.into());
        let name = path.join("$");
        if signal.descriptor().name == "clock" {
            self.ports.clocks.push(name.clone());
        }
        let width = u32::try_from(signal.bits()).unwrap_or(u32::MAX);
        self.ports.list.push(Port { name, width, direction });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_header_styles_give_the_same_ports() {
        let old = "module m(a,b$0,c);\n input wire a; input wire signed [3:0] b$0;\n output reg [31:0] c;\n reg [7:0] d; endmodule";
        let new = "module m (input wire a, input wire signed [3:0] b$0, output reg [31:0] c); reg [7:0] d; endmodule";
        let ports = Ports::parse(old, "m", &["a"]).unwrap();
        assert_eq!(ports, Ports::parse(new, "m", &["a"]).unwrap());
        let seen: Vec<_> = ports.list.iter().map(|p| (p.name.as_str(), p.width, p.direction)).collect();
        let (i, o) = (Direction::In, Direction::Out);
        assert_eq!(seen, [("a", 1, i), ("b$0", 4, i), ("c", 32, o)]);
        assert_eq!(ports.inputs().count(), 1);
    }

    #[test]
    fn what_cannot_be_carried_is_named() {
        let message = |verilog, module, clocks: &[&str]| Ports::parse(verilog, module, clocks).unwrap_err().to_string();
        assert!(message("module a(); endmodule", "b", &[]).contains("it has: a"));
        assert!(message("module a(input [32:0] x); endmodule", "a", &[]).contains("33 bits"));
        assert!(message("module a(input [W:0] x); endmodule", "a", &[]).contains("`x`"));
        assert!(message("module a(input x); endmodule", "a", &["c"]).contains("`c`"));
    }
}
