//! Independent pieces of a long procedure, which its caller may run in parallel.

use crate::watch::{Stopped, Watch, part};

/// Piece of work that needs no result of another piece of its procedure. It writes its result to a
/// place that it borrows, and stops if its watch returns `false`.
pub type WorkPiece<'a> = Box<dyn FnOnce(Watch<'_>) -> Result<(), Stopped> + Send + 'a>;

/// Owner of the threads. The result of a procedure does not depend on it.
#[derive(Clone, Copy, Debug)]
pub struct Workers {
    /// Number of pieces that run at once, at least 1.
    pub at_once: usize,
    /// Runs all pieces, each with its own watch, and reports the progress of the stage; [`Stopped`]
    /// if the watch or a piece stopped.
    pub work: fn(Vec<WorkPiece<'_>>, &'static str, Watch<'_>) -> Result<(), Stopped>,
}

impl Workers {
    /// Workers without further threads: the calling thread runs one piece after another.
    ///
    /// # Example
    /// ```
    /// use phea_dynamics::pieces::{WorkPiece, Workers};
    /// use phea_dynamics::watch::{Stopped, Watch, unwatched};
    /// let mut squares = [0; 4];
    /// let places = squares.iter_mut().enumerate();
    /// let square = |(index, place): (usize, &mut usize)| *place = index * index;
    /// let pieces = places.map(|place| -> WorkPiece<'_> {
    ///     Box::new(move |_: Watch<'_>| {
    ///         square(place);
    ///         Ok::<(), Stopped>(())
    ///     })
    /// });
    /// Workers::CALLER.work(pieces.collect(), "squaring", &mut unwatched)?;
    /// assert_eq!(squares, [0, 1, 4, 9]);
    /// # Ok::<(), Stopped>(())
    /// ```
    pub const CALLER: Workers = Workers { at_once: 1, work: one_by_one };

    /// Runs all pieces.
    ///
    /// # Errors
    /// [`Stopped`] if the watch returns `false`.
    pub fn work(
        self,
        pieces: Vec<WorkPiece<'_>>,
        stage: &'static str,
        watch: Watch<'_>,
    ) -> Result<(), Stopped> {
        (self.work)(pieces, stage, watch)
    }
}

impl PartialEq for Workers {
    fn eq(&self, other: &Workers) -> bool {
        self.at_once == other.at_once && std::ptr::fn_addr_eq(self.work, other.work)
    }
}

fn one_by_one(pieces: Vec<WorkPiece<'_>>, stage: &'static str, watch: Watch<'_>) -> Result<(), Stopped> {
    let count = pieces.len() as f64;
    for (index, piece) in pieces.into_iter().enumerate() {
        let fraction = [index, index + 1].map(|done| done as f64 / count);
        piece(&mut part(&mut *watch, stage, fraction))?;
    }
    Ok(())
}
