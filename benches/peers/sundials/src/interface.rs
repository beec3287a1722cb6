//! Part of the C interface of SUNDIALS 6 that is used, in double precision with 64-bit indices.

use std::ffi::{c_char, c_int, c_long, c_void};

/// An object of the library, as a pointer.
pub(crate) type Object = *mut c_void;

/// `CVRhsFn`: time, state, derivative, user data; 0, positive to request a shorter step, negative
/// to give up.
pub(crate) type RightHandSide = unsafe extern "C" fn(f64, Object, Object, *mut c_void) -> c_int;

pub(crate) const ADAMS: c_int = 1;
pub(crate) const BACKWARD_DIFFERENTIATION: c_int = 2;
pub(crate) const NORMAL: c_int = 1;

#[link(name = "sundials_nvecserial")]
unsafe extern "C" {
    pub(crate) fn N_VNew_Serial(length: i64, context: Object) -> Object;
    pub(crate) fn N_VGetArrayPointer(vector: Object) -> *mut f64;
    pub(crate) fn N_VDestroy(vector: Object);
}

#[link(name = "sundials_cvode")]
unsafe extern "C" {
    pub(crate) fn SUNDIALSGetVersionNumber(
        major: *mut c_int,
        minor: *mut c_int,
        patch: *mut c_int,
        label: *mut c_char,
        length: c_int,
    ) -> c_int;
    pub(crate) fn SUNContext_Create(communicator: *mut c_void, context: *mut Object) -> c_int;
    pub(crate) fn SUNContext_Free(context: *mut Object) -> c_int;
    pub(crate) fn SUNDenseMatrix(rows: i64, columns: i64, context: Object) -> Object;
    pub(crate) fn SUNMatDestroy(matrix: Object);
    pub(crate) fn SUNLinSol_Dense(vector: Object, matrix: Object, context: Object) -> Object;
    pub(crate) fn SUNLinSolFree(solver: Object) -> c_int;
    pub(crate) fn CVodeCreate(method: c_int, context: Object) -> Object;
    pub(crate) fn CVodeFree(cvode: *mut Object);
    pub(crate) fn CVodeInit(cvode: Object, rates: RightHandSide, time: f64, state: Object) -> c_int;
    pub(crate) fn CVodeReInit(cvode: Object, time: f64, state: Object) -> c_int;
    pub(crate) fn CVodeSVtolerances(cvode: Object, relative: f64, absolute: Object) -> c_int;
    pub(crate) fn CVodeSetLinearSolver(cvode: Object, solver: Object, matrix: Object) -> c_int;
    pub(crate) fn CVodeSetUserData(cvode: Object, data: *mut c_void) -> c_int;
    pub(crate) fn CVodeSetErrFile(cvode: Object, file: *mut c_void) -> c_int;
    pub(crate) fn CVodeSetMaxNumSteps(cvode: Object, steps: c_long) -> c_int;
    pub(crate) fn CVodeSetStabLimDet(cvode: Object, on: c_int) -> c_int;
    pub(crate) fn CVodeSetStopTime(cvode: Object, time: f64) -> c_int;
    pub(crate) fn CVode(cvode: Object, until: f64, state: Object, reached: *mut f64, task: c_int) -> c_int;
}
