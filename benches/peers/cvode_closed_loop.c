/* The closed loop of closed_loop.h on CVODE (SUNDIALS 6).
 *
 *   gcc -O3 -march=native cvode_closed_loop.c -o cvode_closed_loop -lsundials_cvode -lsundials_nvecserial -lm
 *   ./cvode_closed_loop METHOD TOLERANCE [repeats=N] [output=FILE] [restart_at_motion=0] [parameter=value]...
 *
 * METHOD: bdf, bdf_stability (with stability-limit detection), adams (Newton), adams_functional (fixed point).
 * TOLERANCE: relative, and absolute as that fraction of each state's typical magnitude. CVODE starts anew where the
 * reference steps, at each sample, and unless told not to where the load's motion begins and ends.
 * Prints processor time per run, the best and the mean of the repeats, and the work of one run.
 * With -shared -fPIC in place of a program: the library that comparisons/closed_loop.py loads. */
#include "closed_loop.h"
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

static const char *const METHODS[] = {"bdf", "bdf_stability", "adams", "adams_functional"};
enum method { BDF, BDF_STABILITY, ADAMS, ADAMS_FUNCTIONAL };

struct options {
    int method;
    double tolerance;
    int restart_at_motion;
};

/* Work of one run; evaluations for the difference quotients of the Jacobian are counted apart. */
struct work {
    long steps, evaluations, jacobian_evaluations, jacobians, error_failures, starts;
};

struct problem {
    const struct closed_loop *rig;
    struct inputs inputs;
};

static int evaluate(sunrealtype time, N_Vector state, N_Vector derivative, void *user) {
    const struct problem *problem = user;
    rates(problem->rig, &problem->inputs, time, NV_DATA_S(state), NV_DATA_S(derivative));
    return 0;
}

static void count(void *cvode, int method, struct work *work) {
    long value;
    CVodeGetNumSteps(cvode, &value), work->steps += value;
    CVodeGetNumRhsEvals(cvode, &value), work->evaluations += value;
    CVodeGetNumErrTestFails(cvode, &value), work->error_failures += value;
    work->starts++;
    if (method == ADAMS_FUNCTIONAL) return;
    CVodeGetNumLinRhsEvals(cvode, &value), work->jacobian_evaluations += value;
    CVodeGetNumJacEvals(cvode, &value), work->jacobians += value;
}

/* The earliest time after `now` at which something changes at once, or the end of the run. */
static double next_break(const struct closed_loop *rig, const struct options *options, double now, long samples) {
    double next = rig->duration, step = rig->motion_time_constant > 0;
    double breaks[4] = {rig->reference_time, step || options->restart_at_motion ? rig->motion_start : next,
                        !step && options->restart_at_motion ? rig->motion_start + rig->motion_duration : next,
                        rig->sample_time > 0 ? (double)(samples + 1) * rig->sample_time : next};
    for (int i = 0; i < 4; i++)
        if (breaks[i] > now + 1e-12 && breaks[i] < next - 1e-12) next = breaks[i];
    return next;
}

/* From break to break; a row at each output time, as interpolated by CVODE. */
static int march(void *cvode, N_Vector state, struct problem *problem, const struct options *options, double *rows, struct work *work) {
    const struct closed_loop *rig = problem->rig;
    struct inputs *inputs = &problem->inputs;
    long count_rows = row_count(rig), row = 0, samples = -1;
    double now = 0, last_error = 0;
    sunrealtype reached = 0;
    while (row < count_rows) {
        inputs->reference = now >= rig->reference_time - 1e-12 ? rig->reference_force : 0;
        inputs->moved = now >= rig->motion_start - 1e-12;
        if (rig->sample_time > 0 && now >= (double)(samples + 1) * rig->sample_time - 1e-12)
            samples++, sample(rig, inputs, &last_error, NV_DATA_S(state));
        if (row == 0) write_row(rig, inputs, 0, NV_DATA_S(state), rows), row++;
        if (now > 0) {
            count(cvode, options->method, work);
            int status = CVodeReInit(cvode, now, state);
            if (status < 0) return status;
        }
        double stop = next_break(rig, options, now, samples);
        CVodeSetStopTime(cvode, stop);
        for (; row < count_rows && (double)row * rig->output_step <= stop + 1e-12; row++) {
            double time = (double)row * rig->output_step;
            int status = CVode(cvode, time < stop ? time : stop, state, &reached, CV_NORMAL);
            if (status < 0) return status;
            write_row(rig, inputs, time, NV_DATA_S(state), rows + row * COLUMNS);
        }
        int status = reached < stop - 1e-12 ? CVode(cvode, stop, state, &reached, CV_NORMAL) : 0;
        if (status < 0) return status;
        now = stop;
    }
    count(cvode, options->method, work);
    return 0;
}

/* One run into rows of COLUMNS numbers; CVODE's negative status if it fails. */
int cvode_closed_loop(const struct closed_loop *rig, const struct options *options, double *rows, struct work *work) {
    SUNContext context;
    SUNContext_Create(NULL, &context);
    N_Vector state = N_VNew_Serial(STATES, context), tolerances = N_VClone(state);
    start_state(rig, NV_DATA_S(state));
    for (int i = 0; i < STATES; i++) NV_DATA_S(tolerances)[i] = options->tolerance * SCALES[i];
    struct problem problem = {rig, {0, 0, 0, 0}};
    void *cvode = CVodeCreate(options->method <= BDF_STABILITY ? CV_BDF : CV_ADAMS, context);
    CVodeInit(cvode, evaluate, 0, state);
    CVodeSVtolerances(cvode, options->tolerance, tolerances);
    CVodeSetUserData(cvode, &problem);
    CVodeSetMaxNumSteps(cvode, 20000000);
    CVodeSetErrFile(cvode, NULL);
    SUNMatrix matrix = SUNDenseMatrix(STATES, STATES, context);
    SUNLinearSolver linear = SUNLinSol_Dense(state, matrix, context);
    SUNNonlinearSolver functional = SUNNonlinSol_FixedPoint(state, 0, context);
    if (options->method == ADAMS_FUNCTIONAL) CVodeSetNonlinearSolver(cvode, functional);
    else CVodeSetLinearSolver(cvode, linear, matrix);
    if (options->method == BDF_STABILITY) CVodeSetStabLimDet(cvode, 1);
    memset(work, 0, sizeof *work);
    int status = march(cvode, state, &problem, options, rows, work);
    CVodeFree(&cvode);
    SUNNonlinSolFree(functional);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    N_VDestroy(tolerances);
    N_VDestroy(state);
    SUNContext_Free(&context);
    return status;
}

static int method_named(const char *name) {
    for (int i = 0; i <= ADAMS_FUNCTIONAL; i++)
        if (!strcmp(name, METHODS[i])) return i;
    return -1;
}

int main(int count, char **words) {
    struct closed_loop rig = default_closed_loop();
    struct options options = {count > 2 ? method_named(words[1]) : -1, count > 2 ? atof(words[2]) : 0, 1};
    const char *output = NULL;
    int repeats = 1, bad = options.method < 0 || options.tolerance <= 0;
    for (int i = 3; i < count; i++) {
        if (!strncmp(words[i], "repeats=", 8)) repeats = atoi(words[i] + 8);
        else if (!strncmp(words[i], "output=", 7)) output = words[i] + 7;
        else if (!strncmp(words[i], "restart_at_motion=", 18)) options.restart_at_motion = atoi(words[i] + 18);
        else bad |= !set_parameter(&rig, words[i]);
    }
    if (bad) return fprintf(stderr, "see the head of cvode_closed_loop.c for the arguments\n"), 2;

    double *rows = malloc(sizeof(double) * COLUMNS * (size_t)row_count(&rig)), best = INFINITY, total = 0;
    struct work work;
    for (int i = 0; i < repeats; i++) {
        double before = processor_seconds();
        int status = cvode_closed_loop(&rig, &options, rows, &work);
        if (status < 0) return fprintf(stderr, "CVODE fails with %d\n", status), 1;
        double seconds = processor_seconds() - before;
        total += seconds;
        best = seconds < best ? seconds : best;
    }
    printf("%s %g best_ms %.3f mean_ms %.3f steps %ld evaluations %ld jacobian_evaluations %ld jacobians %ld error_failures %ld starts %ld\n",
           words[1], options.tolerance, 1e3 * best, 1e3 * total / repeats, work.steps, work.evaluations,
           work.jacobian_evaluations, work.jacobians, work.error_failures, work.starts);
    int written = !output || write_file(output, rows, row_count(&rig));
    free(rows);
    return written ? 0 : 1;
}
