//! An integrator of the library with everything that it holds, freed when dropped.

use std::any::Any;
use std::ffi::{c_int, c_void};
use std::marker::PhantomData;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::ptr::null_mut;

use crate::interface::{self as c, Object};
use crate::{CvodeError, MOST_STEPS, Method, Rates};

/// Data that the right-hand side reaches through CVODE's user data.
struct Caller<'a> {
    rates: &'a mut Rates<'a>,
    states: usize,
    /// Range to which the times passed to `rates` are clamped.
    from: f64,
    until: f64,
    panic: Option<Box<dyn Any + Send>>,
}

/// An initialised integrator.
pub(crate) struct Session<'a> {
    objects: Objects,
    /// Time at which CVODE began or restarted.
    begun: f64,
    /// Owned; a bare pointer, because CVODE has a copy of it.
    caller: *mut Caller<'a>,
    owned: PhantomData<Caller<'a>>,
}

/// The objects of the library, null until created.
struct Objects {
    context: Object,
    state: Object,
    tolerances: Object,
    matrix: Object,
    solver: Object,
    cvode: Object,
}

impl<'a> Session<'a> {
    /// Creates an integrator at `start`, ready to advance.
    pub(crate) fn new(
        rates: &'a mut Rates<'a>,
        start: &[f64],
        time: f64,
        relative: f64,
        absolute: &[f64],
        method: Method,
    ) -> Result<Self, CvodeError> {
        check_version()?;
        let objects = Objects::new(start, absolute, method)?;
        let caller = Caller { rates, states: start.len(), from: time, until: time, panic: None };
        let session =
            Self { objects, begun: time, caller: Box::into_raw(Box::new(caller)), owned: PhantomData };
        let Objects { state, tolerances, matrix, solver, cvode, .. } = session.objects;
        // SAFETY: all objects are alive and of one context; the caller outlives the integrator (see
        // `drop`).
        let statuses = unsafe {
            [
                c::CVodeInit(cvode, right_hand_side, time, state),
                c::CVodeSVtolerances(cvode, relative, tolerances),
                c::CVodeSetLinearSolver(cvode, solver, matrix),
                c::CVodeSetUserData(cvode, session.caller.cast()),
                c::CVodeSetErrFile(cvode, null_mut()),
                c::CVodeSetMaxNumSteps(cvode, MOST_STEPS),
                c::CVodeSetStabLimDet(cvode, c_int::from(method == Method::StabilityLimit)),
            ]
        };
        statuses.into_iter().try_for_each(|status| session.judge(status, time))?;
        Ok(session)
    }

    /// Limits steps to `end`, where a piece of the rates ends.
    pub(crate) fn set_end(&mut self, end: f64) -> Result<(), CvodeError> {
        // SAFETY: the caller is alive, and no call into CVODE is under way.
        unsafe { (*self.caller).until = end.next_down() };
        // SAFETY: the integrator is alive.
        self.judge(unsafe { c::CVodeSetStopTime(self.objects.cvode, end) }, end)
    }

    /// The state at `time`, at or before the end that was set. CVODE does not begin within a few
    /// roundings of the start time: there the state is still the initial one.
    pub(crate) fn advance(&mut self, time: f64) -> Result<Vec<f64>, CvodeError> {
        if time - self.begun <= 4.0 * f64::EPSILON * time.abs().max(self.begun.abs()) {
            return Ok(self.state());
        }
        let mut reached = time;
        // SAFETY: integrator and state are alive; `right_hand_side` propagates no panic.
        let status =
            unsafe { c::CVode(self.objects.cvode, time, self.objects.state, &mut reached, c::NORMAL) };
        // SAFETY: the caller is alive, and no call into CVODE is under way.
        if let Some(panic) = unsafe { (*self.caller).panic.take() } {
            resume_unwind(panic);
        }
        self.judge(status, reached)?;
        Ok(self.state())
    }

    fn state(&self) -> Vec<f64> {
        // SAFETY: the vector was created with this number of elements, and nothing writes to it
        // now; the caller is alive.
        unsafe {
            let first = c::N_VGetArrayPointer(self.objects.state);
            std::slice::from_raw_parts(first, (*self.caller).states).to_vec()
        }
    }

    /// Discards the history before `time`; the state remains.
    pub(crate) fn restart(&mut self, time: f64) -> Result<(), CvodeError> {
        // SAFETY: as in `set_end`.
        unsafe { (*self.caller).from = time };
        self.begun = time;
        self.judge(unsafe { c::CVodeReInit(self.objects.cvode, time, self.objects.state) }, time)
    }

    fn judge(&self, status: c_int, time: f64) -> Result<(), CvodeError> {
        if status < 0 { Err(CvodeError::Failed { status, time }) } else { Ok(()) }
    }
}

impl Drop for Session<'_> {
    fn drop(&mut self) {
        // SAFETY: created by `Box::into_raw` in `new`, freed only here; CVODE calls nothing while
        // it is freed after this.
        drop(unsafe { Box::from_raw(self.caller) });
    }
}

impl Objects {
    fn new(start: &[f64], absolute: &[f64], method: Method) -> Result<Self, CvodeError> {
        let null = null_mut();
        let mut made =
            Self { context: null, state: null, tolerances: null, matrix: null, solver: null, cvode: null };
        let kind = if method == Method::Adams { c::ADAMS } else { c::BACKWARD_DIFFERENTIATION };
        let length = i64::try_from(start.len()).map_err(|_| CvodeError::Memory)?;
        // SAFETY: each object is created from objects that were created before it and are not null.
        unsafe {
            if c::SUNContext_Create(null_mut(), &mut made.context) != 0 {
                return Err(CvodeError::Memory);
            }
            made.state = vector(start, length, made.context)?;
            made.tolerances = vector(absolute, length, made.context)?;
            made.matrix = present(c::SUNDenseMatrix(length, length, made.context))?;
            made.solver = present(c::SUNLinSol_Dense(made.state, made.matrix, made.context))?;
            made.cvode = present(c::CVodeCreate(kind, made.context))?;
        }
        Ok(made)
    }
}

impl Drop for Objects {
    fn drop(&mut self) {
        // SAFETY: each is null or alive, and freed once, the context last.
        unsafe {
            if !self.cvode.is_null() {
                c::CVodeFree(&mut self.cvode);
            }
            if !self.solver.is_null() {
                c::SUNLinSolFree(self.solver);
            }
            if !self.matrix.is_null() {
                c::SUNMatDestroy(self.matrix);
            }
            for made in [self.tolerances, self.state] {
                if !made.is_null() {
                    c::N_VDestroy(made);
                }
            }
            if !self.context.is_null() {
                c::SUNContext_Free(&mut self.context);
            }
        }
    }
}

fn present(object: Object) -> Result<Object, CvodeError> {
    if object.is_null() { Err(CvodeError::Memory) } else { Ok(object) }
}

/// # Safety
///
/// `context` is alive, and `length` is that of `values`.
unsafe fn vector(values: &[f64], length: i64, context: Object) -> Result<Object, CvodeError> {
    // SAFETY: the new vector has as many elements as are written.
    unsafe {
        let vector = present(c::N_VNew_Serial(length, context))?;
        std::ptr::copy_nonoverlapping(values.as_ptr(), c::N_VGetArrayPointer(vector), values.len());
        Ok(vector)
    }
}

fn check_version() -> Result<(), CvodeError> {
    let (mut major, mut minor, mut patch, mut label) = (0, 0, 0, [0; 32]);
    // SAFETY: the label has room for the stated number of characters.
    unsafe { c::SUNDIALSGetVersionNumber(&mut major, &mut minor, &mut patch, label.as_mut_ptr(), 32) };
    if major == 6 { Ok(()) } else { Err(CvodeError::Version { major }) }
}

unsafe extern "C" fn right_hand_side(time: f64, state: Object, rates: Object, caller: *mut c_void) -> c_int {
    // SAFETY: CVODE returns the user data that it was given, and two vectors of the length of the
    // state.
    let (caller, state, rates) = unsafe {
        let caller = &mut *caller.cast::<Caller>();
        let length = caller.states;
        let state = std::slice::from_raw_parts(c::N_VGetArrayPointer(state), length);
        (caller, state, std::slice::from_raw_parts_mut(c::N_VGetArrayPointer(rates), length))
    };
    let time = time.min(caller.until).max(caller.from);
    match catch_unwind(AssertUnwindSafe(|| (caller.rates)(time, state, rates))) {
        Ok(()) if rates.iter().all(|rate| rate.is_finite()) => 0,
        Ok(()) => 1,
        Err(panic) => {
            caller.panic = Some(panic);
            -1
        }
    }
}
