//! Verilog tokens.
//!
//! Renaming and merging work on tokens, so that `$signed`, `32'h1` and the inside of a comment are
//! never mistaken for an identifier. Every character of the input ends up in exactly one token:
//! joining the texts gives the input back.
//!
//! ```text
//! text   assign q$0 = $signed(8'h3f); // x
//! kind   I     .I   .S.Y     SN     S S.C
//! ```

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Blanks and line ends.
    Space,
    /// `// …` without its line end, or `/* … */`.
    Comment,
    /// An identifier or a keyword, `$` inside allowed; also an escaped identifier.
    Ident,
    /// A system task or function: `$signed`.
    System,
    /// A number, sized or not: `16'hffff`.
    Number,
    /// A string with its quotes.
    Text,
    /// A compiler directive with its backquote.
    Directive,
    /// Any other single character.
    Symbol,
}

/// A piece of Verilog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token<'a> {
    /// Which of the lexical classes it belongs to.
    pub kind: Kind,
    /// How it is spelled.
    pub text: &'a str,
}

impl Token<'_> {
    /// Whether a parser may pass over it.
    #[must_use]
    pub fn is_blank(&self) -> bool {
        matches!(self.kind, Kind::Space | Kind::Comment)
    }

    /// Whether it is this word or symbol.
    #[must_use]
    pub fn is(&self, text: &str) -> bool {
        !self.is_blank() && self.kind != Kind::Text && self.text == text
    }
}

/// Cuts a Verilog text into tokens. Never fails: what it does not know is a symbol.
#[must_use]
pub fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let (kind, length) = scan(rest, first);
        let (head, tail) = rest.split_at(length);
        found.push(Token { kind, text: head });
        rest = tail;
    }
    found
}

fn scan(rest: &str, first: char) -> (Kind, usize) {
    let run = |accept: fn(char) -> bool| rest.find(|c| !accept(c)).unwrap_or(rest.len());
    match first {
        c if c.is_whitespace() => (Kind::Space, run(char::is_whitespace)),
        '/' if rest.starts_with("//") => (Kind::Comment, rest.find('\n').unwrap_or(rest.len())),
        '/' if rest.starts_with("/*") => (Kind::Comment, rest.find("*/").map_or(rest.len(), |end| end + 2)),
        '"' => (Kind::Text, text_length(rest)),
        '\\' => (Kind::Ident, rest.find(char::is_whitespace).unwrap_or(rest.len())),
        '`' => (Kind::Directive, 1 + word_length(&rest[1..])),
        '$' => (Kind::System, 1 + word_length(&rest[1..])),
        c if c.is_ascii_alphabetic() || c == '_' => (Kind::Ident, word_length(rest)),
        c if c.is_ascii_digit() || c == '\'' => (Kind::Number, number_length(rest)),
        c => (Kind::Symbol, c.len_utf8()),
    }
}

fn word_length(rest: &str) -> usize {
    rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '$')).unwrap_or(rest.len())
}

fn text_length(rest: &str) -> usize {
    let mut escaped = false;
    for (at, c) in rest.char_indices().skip(1) {
        match c {
            '"' if !escaped => return at + 1,
            '\\' => escaped = !escaped,
            _ => escaped = false,
        }
    }
    rest.len()
}

fn number_length(rest: &str) -> usize {
    let digits = |text: &str, accept: fn(char) -> bool| text.find(|c| !accept(c)).unwrap_or(text.len());
    let size = digits(rest, |c| c.is_ascii_digit() || c == '_');
    let Some(based) = rest[size..].strip_prefix('\'') else {
        return size.max(1);
    };
    let sign = usize::from(based.starts_with(['s', 'S']));
    if !based[sign..].starts_with(['b', 'o', 'd', 'h', 'B', 'O', 'D', 'H']) {
        return size + 1;
    }
    let value = &based[sign + 1..];
    size + 2 + sign + digits(value, |c| c.is_ascii_hexdigit() || "xXzZ?_".contains(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<(Kind, &str)> {
        tokens(text).iter().filter(|t| t.kind != Kind::Space).map(|t| (t.kind, t.text)).collect()
    }

    #[test]
    fn words_numbers_and_system_functions_are_told_apart() {
        assert_eq!(
            kinds("q$0 = $signed(16'hfF)+32'h1;// a$b"),
            [
                (Kind::Ident, "q$0"),
                (Kind::Symbol, "="),
                (Kind::System, "$signed"),
                (Kind::Symbol, "("),
                (Kind::Number, "16'hfF"),
                (Kind::Symbol, ")"),
                (Kind::Symbol, "+"),
                (Kind::Number, "32'h1"),
                (Kind::Symbol, ";"),
                (Kind::Comment, "// a$b"),
            ]
        );
    }

    #[test]
    fn strings_directives_and_comments_are_whole() {
        assert_eq!(
            kinds("`default_nettype none /* a \n b */ \"x \\\" $y\" \\esc$ape z"),
            [
                (Kind::Directive, "`default_nettype"),
                (Kind::Ident, "none"),
                (Kind::Comment, "/* a \n b */"),
                (Kind::Text, "\"x \\\" $y\""),
                (Kind::Ident, "\\esc$ape"),
                (Kind::Ident, "z"),
            ]
        );
    }

    #[test]
    fn nothing_is_lost_whatever_the_text() {
        for text in ["", "'", "1'", "8'q", "\"open", "/* open", "a\u{e9}b", "\\", "$", "`", "x[(8)+:(8)]"] {
            let joined: String = tokens(text).iter().map(|t| t.text).collect();
            assert_eq!(joined, text);
        }
    }
}
