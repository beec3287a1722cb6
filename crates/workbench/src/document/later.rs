//! Blocks of a page that are made when they are first shown.

use std::sync::{Arc, LazyLock};

use super::Document;

/// Blocks that cost time to make and that a terminal leaves out, such as figures.
#[derive(Clone, Debug)]
pub(super) struct LaterBlocks(Arc<LazyLock<Document, MakeBlocks>>);

type MakeBlocks = Box<dyn FnOnce() -> Document + Send>;

impl LaterBlocks {
    pub(super) fn new(make: impl FnOnce() -> Document + Send + 'static) -> LaterBlocks {
        LaterBlocks(Arc::new(LazyLock::new(Box::new(make))))
    }

    /// The blocks, made once.
    pub(super) fn blocks(&self) -> &Document {
        &self.0
    }
}

/// Documents with equal results have equal blocks, which follow from the results.
impl PartialEq for LaterBlocks {
    fn eq(&self, _other: &LaterBlocks) -> bool {
        true
    }
}
