/* The closed loop of closed_loop.h by the classical Runge-Kutta method of order four in fixed steps.
 *
 *   gcc -O3 -march=native runge_kutta_closed_loop.c -o runge_kutta_closed_loop -lm
 *   ./runge_kutta_closed_loop STEPS_PER_OUTPUT [repeats=N] [output=FILE] [parameter=value]...
 *
 * With -DREAL="long double" the states carry 64 bits of mantissa: a check on rounding. Breaks (reference, motion,
 * samples) are taken at the nearest step. Prints processor time per run, the best and the mean of the repeats.
 * With -shared -fPIC in place of a program: the library that comparisons/closed_loop.py loads. */
#include "closed_loop.h"

static void step(const struct closed_loop *rig, const struct inputs *inputs, REAL time, REAL h, REAL y[STATES]) {
    REAL first[STATES], second[STATES], third[STATES], fourth[STATES], stage[STATES];
    rates(rig, inputs, time, y, first);
    for (int i = 0; i < STATES; i++) stage[i] = y[i] + h / 2 * first[i];
    rates(rig, inputs, time + h / 2, stage, second);
    for (int i = 0; i < STATES; i++) stage[i] = y[i] + h / 2 * second[i];
    rates(rig, inputs, time + h / 2, stage, third);
    for (int i = 0; i < STATES; i++) stage[i] = y[i] + h * third[i];
    rates(rig, inputs, time + h, stage, fourth);
    for (int i = 0; i < STATES; i++) y[i] += h / 6 * (first[i] + 2 * (second[i] + third[i]) + fourth[i]);
}

/* One run into rows of COLUMNS numbers; -1 if a state ceases to be a number. */
int runge_kutta_closed_loop(const struct closed_loop *rig, long steps_per_output, double *rows) {
    REAL y[STATES], last_error = 0, h = (REAL)rig->output_step / steps_per_output;
    struct inputs inputs = {0, 0, 0, 0};
    long outputs = row_count(rig) - 1, reference_step = lround(rig->reference_time / (double)h);
    long motion_step = lround(rig->motion_start / (double)h);
    long sample_steps = rig->sample_time > 0 ? lround(rig->sample_time / (double)h) : 0;
    start_state(rig, y);
    for (long i = 0; i <= outputs * steps_per_output; i++) {
        inputs.reference = i >= reference_step ? rig->reference_force : 0;
        inputs.moved = i >= motion_step;
        REAL before = inputs.command;
        if (sample_steps && i % sample_steps == 0) sample(rig, &inputs, &last_error, y);
        if (i % steps_per_output == 0) {
            struct inputs held = inputs;
            if (sample_steps && i > 0) held.command = before;
            write_row(rig, &held, i * h, y, rows + i / steps_per_output * COLUMNS);
        }
        step(rig, &inputs, i * h, h, y);
    }
    return isfinite((double)y[DEFLECTION]) ? 0 : -1;
}

int main(int count, char **words) {
    struct closed_loop rig = default_closed_loop();
    const char *output = NULL;
    long steps_per_output = count > 1 ? atol(words[1]) : 0;
    int repeats = 1, bad = steps_per_output < 1;
    for (int i = 2; i < count; i++) {
        if (!strncmp(words[i], "repeats=", 8)) repeats = atoi(words[i] + 8);
        else if (!strncmp(words[i], "output=", 7)) output = words[i] + 7;
        else bad |= !set_parameter(&rig, words[i]);
    }
    if (bad) return fprintf(stderr, "see the head of runge_kutta_closed_loop.c for the arguments\n"), 2;

    double *rows = malloc(sizeof(double) * COLUMNS * (size_t)row_count(&rig)), best = INFINITY, total = 0;
    for (int i = 0; i < repeats; i++) {
        double before = processor_seconds();
        if (runge_kutta_closed_loop(&rig, steps_per_output, rows) < 0) return fprintf(stderr, "unstable\n"), 1;
        double seconds = processor_seconds() - before;
        total += seconds;
        best = seconds < best ? seconds : best;
    }
    printf("runge_kutta %g best_ms %.3f mean_ms %.3f steps %ld\n", rig.output_step / (double)steps_per_output, 1e3 * best,
           1e3 * total / repeats, (row_count(&rig) - 1) * steps_per_output);
    int written = !output || write_file(output, rows, row_count(&rig));
    free(rows);
    return written ? 0 : 1;
}
