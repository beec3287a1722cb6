/* A force-controlled hydraulic axis, written in C so that other solvers than phea's can be run on it.
 *
 *   valve      spool'' = w^2 (command - spool) - 2 D w spool'
 *   edges      q = (K n + L sech(lambda n)) dp / (dp^2 + dp_t^2)^(1/4),   n = spool / nominal voltage, on its own side only
 *   pressures  C_A p_A' = q_PA - q_AT - q_AB - A_A v,   C_B p_B' = q_PB - q_BT + q_AB + A_B v,   q_AB = G (p_A - p_B)
 *              C_A = V_lA/beta_lA + (V_0A + A_A x)/beta,    C_B = V_lB/beta_lB + (V_0B + A_B (stroke - x))/beta
 *   piston     M v' = A_A p_A - A_B p_B - F_f - F_e,   F_e = K_S d,   d' = v - v_L,   x = x_L + d
 *   friction   z' = v - sigma_0 |v| z / g(v),   g = F_C + (F_S - F_C) exp(-|v/v_S|^alpha),   F_f = sigma_0 z + sigma_1 z' + sigma_2 v
 *   control    u = K_p e + I, limited, I' = K_i e without anti-windup, e = r - F_e
 *   prefilter  r'' = c (F_ref - r) - b r'
 *   load       x_L = x_0 + h s^3 (10 - 15 s + 6 s^2) with s = (t - t_0)/T, or x_0 + h (1 - exp(-(t - t_0)/tau))
 *
 * Ledezma (2019), chapters 4 and 6, with phea's errata. SI units throughout. With one modulus for line and chamber it is
 * the model phea calls `uniform`. Where the controller is sampled, its law is Tustin's, its output is held, and the
 * prefilter stays continuous.
 *
 * REAL is the type that states are computed in: double, or long double as a check on rounding. */
#ifndef CLOSED_LOOP_H
#define CLOSED_LOOP_H
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tgmath.h>
#include <time.h>

#ifndef REAL
#define REAL double
#endif

/* Name and default, in SI units: the benchmark's rig and scenario. */
#define PARAMETERS(X)                                                                                                  \
    X(supply_pressure, 70e5) X(tank_pressure, 0.0) X(transition_pressure, 1e3)                                         \
    X(valve_frequency, 1099.0) X(valve_damping, 0.9) X(nominal_voltage, 10.0) X(leakage_shape, 100.0)                  \
    X(flow_supply_to_a, 3.2e-7) X(flow_a_to_tank, 2.5e-7) X(flow_supply_to_b, 2.0e-7) X(flow_b_to_tank, 3.85e-7)       \
    X(leakage_supply_to_a, 2.35e-9) X(leakage_a_to_tank, 2.2e-9)                                                       \
    X(leakage_supply_to_b, 1.7e-9) X(leakage_b_to_tank, 2.35e-9)                                                       \
    X(area_a, 1.583e-3) X(area_b, 1.583e-3) X(stroke, 0.5) X(chamber_modulus, 2.6e8)                                   \
    X(line_volume_a, 1.9e-4) X(line_volume_b, 1.9e-4) X(line_modulus_a, 2.6e8) X(line_modulus_b, 2.6e8)                \
    X(dead_volume_a, 0.0) X(dead_volume_b, 0.0) X(piston_leakage, 0.0)                                                 \
    X(moving_mass, 13.1) X(sensor_stiffness, 2e7)                                                                      \
    X(coulomb, 80.0) X(static_friction, 120.0) X(stribeck_velocity, 0.01) X(stribeck_exponent, 2.0)                    \
    X(bristle_stiffness, 1e7) X(bristle_damping, 2e3) X(viscous, 100.0)                                                \
    X(proportional_gain, 0.001) X(integral_gain, 0.008) X(saturation, 10.0)                                            \
    X(prefilter_stiffness, 910.0) X(prefilter_damping, 83.0)                                                           \
    X(start_position, 0.25) X(start_pressure_a, 35e5) X(start_pressure_b, 35e5)                                        \
    X(reference_time, 2.0) X(reference_force, 4e3)                                                                     \
    X(motion_start, 3.0) X(motion_duration, 0.1) X(motion_distance, 5e-3) X(motion_time_constant, 0.0)                 \
    X(duration, 5.0) X(output_step, 1e-3) X(sample_time, 0.0)

/* motion_time_constant 0: the quintic; sample_time 0: a continuous controller. */
struct closed_loop {
#define MEMBER(name, value) double name;
    PARAMETERS(MEMBER)
#undef MEMBER
};

enum { SPOOL, SPOOL_RATE, PRESSURE_A, PRESSURE_B, DEFLECTION, VELOCITY, BRISTLE, INTEGRAL, FILTERED, FILTERED_RATE, STATES };

/* Typical magnitude of each state in its unit: an absolute tolerance is a fraction of it. */
static const double SCALES[STATES] = {1.0, 1e3, 1e5, 1e5, 1e-4, 1e-2, 1e-5, 1.0, 1e3, 1e5};

/* What holds between two breaks: the reference, whether the load has been stepped, and the command if it is held. */
struct inputs {
    double reference;
    int moved;
    int held;
    REAL command;
};

/* Columns of a result: time, force, spool, pressure_a, pressure_b, command, position. */
enum { COLUMNS = 7 };

static struct closed_loop default_closed_loop(void) {
    struct closed_loop rig = {
#define VALUE(name, value) .name = value,
        PARAMETERS(VALUE)
#undef VALUE
    };
    return rig;
}

/* Sets the parameter that `assignment`, "name=value", names; 0 if there is none such. */
static int set_parameter(struct closed_loop *rig, const char *assignment) {
    const char *sign = strchr(assignment, '=');
    if (!sign) return 0;
    size_t length = (size_t)(sign - assignment);
#define SET(name, value)                                                                                               \
    if (length == strlen(#name) && !strncmp(assignment, #name, length)) {                                              \
        rig->name = atof(sign + 1);                                                                                    \
        return 1;                                                                                                      \
    }
    PARAMETERS(SET)
#undef SET
    return 0;
}

static void start_state(const struct closed_loop *rig, REAL state[STATES]) {
    for (int i = 0; i < STATES; i++) state[i] = 0;
    state[PRESSURE_A] = rig->start_pressure_a;
    state[PRESSURE_B] = rig->start_pressure_b;
}

static inline void load_motion(const struct closed_loop *rig, int moved, REAL time, REAL *position, REAL *velocity) {
    *position = rig->start_position;
    *velocity = 0;
    REAL since = time - rig->motion_start, height = rig->motion_distance;
    if (rig->motion_time_constant > 0) {
        if (!moved) return;
        REAL decay = exp(-since / rig->motion_time_constant);
        *position += height * (1 - decay);
        *velocity = height / rig->motion_time_constant * decay;
    } else if (since >= rig->motion_duration) {
        *position += height;
    } else if (since > 0) {
        REAL s = since / rig->motion_duration;
        *position += height * s * s * s * (10 - s * (15 - 6 * s));
        *velocity = height / rig->motion_duration * 30 * s * s * (1 - s) * (1 - s);
    }
}

static inline REAL edge_root(REAL drop, REAL transition) {
    return drop / sqrt(sqrt(drop * drop + transition * transition));
}

/* Net flow of the valve into chamber A and into chamber B, m3/s. */
static inline void valve_flows(const struct closed_loop *rig, const REAL *y, REAL *into_a, REAL *into_b) {
    REAL opening = y[SPOOL] / rig->nominal_voltage, leak = 1 / cosh(rig->leakage_shape * opening);
    REAL forward = opening > 0 ? opening : 0, backward = opening < 0 ? -opening : 0, tp = rig->transition_pressure;
    REAL supply_a = (rig->flow_supply_to_a * forward + rig->leakage_supply_to_a * leak) * edge_root(rig->supply_pressure - y[PRESSURE_A], tp);
    REAL a_tank = (rig->flow_a_to_tank * backward + rig->leakage_a_to_tank * leak) * edge_root(y[PRESSURE_A] - rig->tank_pressure, tp);
    REAL supply_b = (rig->flow_supply_to_b * backward + rig->leakage_supply_to_b * leak) * edge_root(rig->supply_pressure - y[PRESSURE_B], tp);
    REAL b_tank = (rig->flow_b_to_tank * forward + rig->leakage_b_to_tank * leak) * edge_root(y[PRESSURE_B] - rig->tank_pressure, tp);
    *into_a = supply_a - a_tank;
    *into_b = supply_b - b_tank;
}

static inline REAL limited_command(const struct closed_loop *rig, const struct inputs *inputs, const REAL *y) {
    if (inputs->held) return inputs->command;
    REAL error = y[FILTERED] - rig->sensor_stiffness * y[DEFLECTION];
    REAL command = rig->proportional_gain * error + y[INTEGRAL];
    return command > rig->saturation ? rig->saturation : command < -rig->saturation ? -rig->saturation : command;
}

/* Time derivatives of the states. */
static inline void rates(const struct closed_loop *rig, const struct inputs *inputs, REAL time, const REAL *y, REAL *dy) {
    REAL load_position, load_velocity, into_a, into_b;
    load_motion(rig, inputs->moved, time, &load_position, &load_velocity);
    valve_flows(rig, y, &into_a, &into_b);

    REAL w = rig->valve_frequency;
    dy[SPOOL] = y[SPOOL_RATE];
    dy[SPOOL_RATE] = w * w * (limited_command(rig, inputs, y) - y[SPOOL]) - 2 * rig->valve_damping * w * y[SPOOL_RATE];

    REAL position = load_position + y[DEFLECTION], v = y[VELOCITY];
    REAL chamber_a = rig->dead_volume_a + rig->area_a * position;
    REAL chamber_b = rig->dead_volume_b + rig->area_b * (rig->stroke - position);
    REAL capacity_a = rig->line_volume_a / rig->line_modulus_a + chamber_a / rig->chamber_modulus;
    REAL capacity_b = rig->line_volume_b / rig->line_modulus_b + chamber_b / rig->chamber_modulus;
    REAL across = rig->piston_leakage * (y[PRESSURE_A] - y[PRESSURE_B]);
    dy[PRESSURE_A] = (into_a - across - rig->area_a * v) / capacity_a;
    dy[PRESSURE_B] = (into_b + across + rig->area_b * v) / capacity_b;

    REAL ratio = fabs(v) / rig->stribeck_velocity;
    REAL power = rig->stribeck_exponent == 2 ? ratio * ratio : pow(ratio, (REAL)rig->stribeck_exponent);
    REAL level = rig->coulomb + (rig->static_friction - rig->coulomb) * exp(-power);
    dy[BRISTLE] = v - rig->bristle_stiffness * fabs(v) * y[BRISTLE] / level;
    REAL friction = rig->bristle_stiffness * y[BRISTLE] + rig->bristle_damping * dy[BRISTLE] + rig->viscous * v;

    REAL force = rig->sensor_stiffness * y[DEFLECTION];
    dy[DEFLECTION] = v - load_velocity;
    dy[VELOCITY] = (rig->area_a * y[PRESSURE_A] - rig->area_b * y[PRESSURE_B] - friction - force) / rig->moving_mass;

    dy[INTEGRAL] = inputs->held ? 0 : rig->integral_gain * (y[FILTERED] - force);
    dy[FILTERED] = y[FILTERED_RATE];
    dy[FILTERED_RATE] = rig->prefilter_stiffness * (inputs->reference - y[FILTERED]) - rig->prefilter_damping * y[FILTERED_RATE];
}

/* The sampled law at one sample: Tustin's rule for the integral, the output limited and held until the next. */
static void sample(const struct closed_loop *rig, struct inputs *inputs, REAL *last_error, REAL *y) {
    REAL error = y[FILTERED] - rig->sensor_stiffness * y[DEFLECTION];
    y[INTEGRAL] += rig->integral_gain * rig->sample_time / 2 * (error + *last_error);
    *last_error = error;
    inputs->held = 0;
    inputs->command = limited_command(rig, inputs, y);
    inputs->held = 1;
}

static void write_row(const struct closed_loop *rig, const struct inputs *inputs, REAL time, const REAL *y, double *row) {
    REAL load_position, load_velocity;
    load_motion(rig, inputs->moved, time, &load_position, &load_velocity);
    row[0] = (double)time;
    row[1] = (double)(rig->sensor_stiffness * y[DEFLECTION]);
    row[2] = (double)y[SPOOL];
    row[3] = (double)y[PRESSURE_A];
    row[4] = (double)y[PRESSURE_B];
    row[5] = (double)limited_command(rig, inputs, y);
    row[6] = (double)(load_position + y[DEFLECTION]);
}

/* Rows of a result: one at each multiple of the output step, the first at time 0. */
static long row_count(const struct closed_loop *rig) { return lround(rig->duration / rig->output_step) + 1; }

static int write_file(const char *name, const double *rows, long count) {
    FILE *file = fopen(name, "w");
    if (!file) return 0;
    fprintf(file, "time_s,force_n,spool_v,pressure_a_pa,pressure_b_pa,command_v,position_m\n");
    for (long i = 0; i < count; i++)
        for (int j = 0; j < COLUMNS; j++) fprintf(file, "%.15g%c", rows[i * COLUMNS + j], j + 1 < COLUMNS ? ',' : '\n');
    return fclose(file) == 0;
}

/* Processor time of this thread, s. */
static double processor_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
