"""Compares the schema of the project file with the reader.

    python comparisons/compare_schema.py

The program `schema_cases` of the package phea-project, or the one that the variable SCHEMA_CASES names, prints the schema
and the reader's verdict on every project of `examples/`, on the valid and the malformed projects of the tests, and on
thousands of mutations. The schema must accept all projects that the reader accepts, and reject every malformed project
except those of `UNSEEN`, which a schema cannot reject.
"""

import json
import os
import pathlib
import subprocess
import sys
import tomllib

import jsonschema

ROOT = pathlib.Path(__file__).resolve().parent.parent

# What a schema cannot see, and the malformed projects that have nothing else wrong with them.
UNSEEN = {
    "two numbers, or two tables, against each other": """
        adjustment_way burst_pressure line_accumulator_ranges line_accumulator_wide controller_conjugate design_improper family_case_outside friction_static_below_coulomb line_stiffening_order operating_point_outside
        operating_region physics_rod_thicker physics_rods_thicker physics_tank_above_supply piston_area_unequal_rods scenario_rows
        scenario_rows_together scenario_start scenario_times scenario_twice sizing_range_reversed specification_band_reversed
        specification_frequencies_empty specification_frequencies_falling specification_limit_table uncertainty_both_sides
        uncertainty_log_zero uncertainty_order uncertainty_points uncertainty_reversed uncertainty_twice_counted valve_closed
        valve_hysteresis valve_leakage_below_tare plant_correlation family_opposed specification_load_motion plant_with_sizing
        line_model_pipe line_model_volume plant_case_incomplete family_measured_empty family_measured_and_grid
        line_accumulator_pressures line_accumulator_temperature supply_accumulator_precharge supply_accumulator_warm uncertainty_direction_ends velocity_sensor_alone cross_port_orifice_wide cross_port_flow_wide series_travel_short series_without_travel series_stop_damping series_stop_missing series_coil_progressive series_vanishing
        impedance_of_nothing impedance_of_position impedance_too_fast impedance_without_load
        motor_stops_without_stroke motor_unserved motor_file
        linkage_open linkage_four_bar_open linkage_dead_point linkage_table_rough linkage_table_short linkage_table_falling
        linkage_table_counts linkage_motor linkage_unserved linkage_units
        price_currencies stage_order stage_count stage_bench transmission_currencies transmission_two_lines transmission_without_line
        adjustment_beside adjustment_course adjustment_ends adjustment_none adjustment_uncertain port_valves_transition
        ranges_reversed supply_accumulator_ranges pressure_feedback design_free_feedback pressure_feedback_without_gain pressure_feedback_beside pressure_feedback_too_fast pressure_feedback_measured design_free_feedback_measured
    """.split(),
    "numbers that a double cannot hold, infinity, and none": """
        number_huge_hexadecimal number_too_large quantity_infinite quantity_nan quantity_too_large quantity_too_small
    """.split(),
    "what a formula says": """
        controller_discrete controller_domain controller_element_sampled controller_formula controller_mixed controller_power
        controller_product controller_zero_denominator plant_delay_name plant_delay_negative plant_delay_variable plant_division
        plant_parameter plant_zero prefilter_continuous prefilter_not_polynomial sensor_discrete sensor_parameter
        specification_limit_formula specification_limit_name specification_limit_decibel specification_limit_negative plant_delay_unit
    """.split(),
    "names of the catalogue, of numbers and of parameters": """
        line_unknown_hose valve_unknown_model uncertainty_unknown uncertainty_dimension campaign_linear campaign_whole_number
        family_replaces velocity_sensor_varied uncertainty_table
    """.split(),
    "one way out of several, and what belongs to it": """
        campaign_forms controller_half controller_no_form controller_two_forms line_model_inherited line_model_keys line_two_kinds
        line_without_length specification_frequencies_missing
        specification_limit_empty specification_limit_missing specification_margin_delay specification_margin_kind
        specification_margin_mixed specification_margin_numerator specification_response_given specification_response_kind
        specification_response_parts specification_tracking
        identify_use_measured identify_use_without_recordings identify_controller_without_law cross_port_half
    """.split(),
}


def cases():
    """The schema, and every case."""
    built = os.environ.get("SCHEMA_CASES")
    command = [built] if built else ["cargo", "run", "--quiet", "-p", "phea-project", "--example", "schema_cases", "--"]
    corpora = ["examples", "crates/project/tests/valid", "crates/project/tests/malformed"]
    paths = [path for folder in corpora for path in sorted((ROOT / folder).rglob("*.toml"))]
    printed = subprocess.run([*command, *paths], cwd=ROOT, stdout=subprocess.PIPE, check=True, text=True).stdout
    schema, *cases = [json.loads(line) for line in printed.splitlines()]
    return schema["schema"], cases


def main():
    schema, every = cases()
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    unseen = {name for names in UNSEEN.values() for name in names}
    wrong, accepted, refused = [], 0, 0
    for case in every:
        if not (case["accepted"] or "/malformed/" in case["name"]):
            continue  # a mutation that the schema may accept or reject
        try:
            project = tomllib.loads(case["text"])
        except tomllib.TOMLDecodeError:
            continue
        name = pathlib.Path(case["name"]).stem
        fault = next(validator.iter_errors(project), None)
        if case["accepted"]:
            accepted += 1
            if fault:
                wrong.append(f"{case['name']}: the reader accepts it, the schema does not: {list(fault.absolute_path)} {fault.message[:200]}")
        else:
            refused += 1
            if (fault is None) != (name in unseen):
                said = "; ".join(case["errors"])
                wrong.append(f"{name}: {'refused' if fault else 'accepted'} by the schema ({said})")
    committed = ROOT / "book/src/phea.schema.json"
    if json.loads(committed.read_text()) != schema:
        wrong.append(f"{committed} is not the schema of the code")
    print("\n".join(wrong))
    print(f"{accepted} accepted projects, {refused} malformed ones, {len(unseen)} of them beyond a schema")
    return 1 if wrong or accepted < 250 else 0


if __name__ == "__main__":
    sys.exit(main())
