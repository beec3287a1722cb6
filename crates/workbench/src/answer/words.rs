//! Enumerations in JSON: a word for each value.

/// A value that is one of a list of words.
pub(crate) trait Word {
    /// The word of this value.
    fn word(&self) -> &'static str;
}

/// Describes an enumeration by its words: `Verdict { Met => "met", Violated => "violated" }`,
/// `Verdict by verdict_key [Met, Violated]` where a function has the words, or
/// `SpecificationKind in SPECIFICATION_KINDS` where a table of the project file has them.
macro_rules! words {
    ($(#[doc = $doc:literal])+ $kind:ident {
        $($variant:ident $(($($inner:tt)*))? $({$($field:tt)*})? => $word:literal),+ $(,)?
    }) => {
        impl $crate::answer::Word for $kind {
            fn word(&self) -> &'static str {
                match self {
                    $($kind::$variant $(($($inner)*))? $({$($field)*})? => $word),+
                }
            }
        }

        $crate::answer::describe_words!([$($doc),+] $kind [$($word),+]);
    };
    ($(#[doc = $doc:literal])+ $kind:ident by $of:path [$($variant:ident),+ $(,)?]) => {
        impl $crate::answer::Word for $kind {
            fn word(&self) -> &'static str {
                match *self {
                    $($kind::$variant)|+ => $of(*self),
                }
            }
        }

        $crate::answer::describe_words!([$($doc),+] $kind [$($of($kind::$variant)),+]);
    };
    ($(#[doc = $doc:literal])+ $kind:ident in $table:ident) => {
        impl $crate::answer::Word for $kind {
            fn word(&self) -> &'static str {
                $crate::project::word_of(&$table, self)
            }
        }

        $crate::answer::describe_words!([$($doc),+] $kind all $table.map(|(word, _)| word).to_vec());
    };
}

macro_rules! describe_words {
    ([$($doc:literal),+] $kind:ident [$($word:expr),+]) => {
        $crate::answer::describe_words!([$($doc),+] $kind all vec![$($word),+]);
    };
    ([$($doc:literal),+] $kind:ident all $words:expr) => {
        impl $crate::answer::Describe for $kind {
            fn shape() -> $crate::answer::ValueShape {
                $crate::answer::ValueShape::Words($crate::answer::WordList {
                    name: stringify!($kind),
                    documentation: concat!($($doc),+),
                    words: $words,
                })
            }

            fn into_json(self) -> $crate::answer::Json {
                $crate::answer::Json::Text($crate::answer::Word::word(&self).to_string())
            }
        }
    };
}

pub(crate) use {describe_words, words};
