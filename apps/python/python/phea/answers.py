"""Answers of the commands: one class for each object of their JSON.

Written by `apps/python/generate_answers.py` from the schema that `phea schema --answers` prints; a
change here is lost. An attribute is the key of the JSON, its unit the end of its name; infinity is
`math.inf`, and a value that does not exist is `None`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, TypeAlias

from phea._record import Answer, Interval, Record


class CheckAnswer(Answer):
    """Answer of `check`.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    derived
        Quantities that follow from the project.
    visited_box
        Ranges of the coefficients of the plant over the family.
    visited_box_evidence
        Evidence for the visited ranges.
    replaced
        Ranges that the project states as replaced by its family.
    requirements_in_time
        Requirements in time of tracking limits.
    warnings
        Warnings about the project.
    impossible
        Requirements that no loop can satisfy.
    """

    schema: int
    version: str
    command: Literal["check"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    derived: tuple[DerivedQuantityAnswer, ...]
    visited_box: tuple[VisitedRangeAnswer, ...] | None
    visited_box_evidence: VisitedEvidence | None
    replaced: tuple[ReplacedRangeAnswer, ...]
    requirements_in_time: tuple[CheckedRequirementAnswer, ...]
    warnings: tuple[str, ...]
    impossible: tuple[ImpossibleAnswer, ...]


TurningMotion: TypeAlias = Literal["rotary"]
"""Motion of a motor."""


class RecordedAnswer(Record):
    """Values identified from the recordings of a project, which replace those of its file.

    Attributes
    ----------
    project_file_sha256
        SHA-256 of the bytes of the project file.
    files
        Recordings in the order of the project.
    values
        Identified values.
    unchanged
        Values that remain as declared.
    tare_pressure_pa
        Pressure drop from supply to tank at which the tare flow was recorded.
    declared_tare_pressure_pa
        Pressure drop from supply to tank at which the tare flow is declared.
    family
        Remaining uncertainty as directions of the family, if in use.
    """

    project_file_sha256: str
    files: tuple[RecordedFileAnswer, ...]
    values: tuple[IdentifiedValueAnswer, ...]
    unchanged: tuple[UnchangedValueAnswer, ...]
    tare_pressure_pa: float
    declared_tare_pressure_pa: float
    family: RecordedFamilyAnswer | None


class RecordedFileAnswer(Record):
    """Recording by its bytes.

    Attributes
    ----------
    file
        Path as in the project.
    sha256
        SHA-256 of the bytes.
    """

    file: str
    sha256: str


class IdentifiedValueAnswer(Record):
    """Value identified from recordings, in `unit`.

    Attributes
    ----------
    path
        Key of the project file.
    value
        Identified value.
    unit
        SI unit of the values.
    confidence_95
        Confidence interval of 95 %, from low to high.
    declared
        Value of the project file; null if it has none.
    """

    path: str
    value: float
    unit: str
    confidence_95: Interval
    declared: float | None


class UnchangedValueAnswer(Record):
    """Value that remains as declared.

    Attributes
    ----------
    path
        Key of the project file.
    reason
        Reason for which it is not replaced.
    """

    path: str
    reason: UnchangedReason


UnchangedReason: TypeAlias = Literal["the recordings do not determine it", "the recordings cannot distinguish it from zero"]
"""Reason for which a declared value is not replaced by an identified one."""


class RecordedFamilyAnswer(Record):
    """Remaining uncertainty of what was identified, as directions of the family.

    Attributes
    ----------
    coverage
        Probability that the truth is in the family, from 0 to 1.
    deviations
        Standard deviations to either side of each direction.
    effects
        Largest relative change of K_qU and K_c along each direction, from its middle to an end.
    left_out
        Number of directions that are omitted because their effect is small.
    effect_left_out
        Largest relative change of K_qU or K_c from the omitted directions together.
    """

    coverage: float
    deviations: float
    effects: tuple[float, ...]
    left_out: int
    effect_left_out: float


class ChosenLinesAnswer(Record):
    """Model chosen for the lines, and the frequencies that it follows from.

    Attributes
    ----------
    model
        Chosen model.
    quarter_wave_rad_per_s
        Lowest frequency at which a line is a quarter of a wave long.
    reached_rad_per_s
        Highest frequency that the loop or a requirement reaches.
    reached_rad_per_s_reason
        Reason for which the value is absent.
    reached_by
        Origin of `reached_rad_per_s`.
    specification
        Number of the specification that reaches it, from 1 in the order of the file.
    lumped_from
        Least ratio of `quarter_wave_rad_per_s` to `reached_rad_per_s` for a lumped model.
    obstacle
        Reason why no model with waves is computed, where one would be needed.
    """

    model: ChosenLineModel
    quarter_wave_rad_per_s: float
    reached_rad_per_s: float | None
    reached_rad_per_s_reason: str | None
    reached_by: ReachedBy | None
    specification: int | None
    lumped_from: float
    obstacle: str | None


ChosenLineModel: TypeAlias = Literal["transmission_line", "lumped"]
"""Model of the lines."""


ReachedBy: TypeAlias = Literal["crossover", "required_time", "design_frequency", "highest_bandwidth", "unlimited_bandwidth"]
"""Origin of the highest frequency that a model of the lines must contain."""


class DerivedQuantityAnswer(Record):
    """Quantity that follows from a project.

    Attributes
    ----------
    name
        Unique name, with dots between its parts.
    group
        Chapter of the list.
    symbol
        Symbol as in the notation, such as `K_H`.
    value
        Value in `unit`; null if it does not exist.
    unit
        SI unit of the value.
    equation
        Equation of the value.
    declared
        Value that the project states instead.
    reason
        Reason for which there is no value.
    """

    name: str
    group: str
    symbol: str
    value: float | None
    unit: str
    equation: str
    declared: StatedAnswer | None
    reason: str | None


class StatedAnswer(Record):
    """Value that the project states for a quantity that also follows from the rest.

    Attributes
    ----------
    value
        Stated value.
    place
        Table of the file that states it, such as `[linear]`.
    bounds
        Least and greatest stated value.
    difference_percent
        Difference of the stated value from the derived one, of the latter; null if that does
        not exist.
    contradicts
        True if the stated value contradicts itself or the derived value.
    """

    value: float
    place: str
    bounds: Interval | None
    difference_percent: float | None
    contradicts: bool


class VisitedRangeAnswer(Record):
    """Range of a coefficient of the plant over the family.

    Attributes
    ----------
    name
        Name of the coefficient.
    symbol
        Symbol of the coefficient.
    unit
        SI unit of its values.
    minimum
        Least value.
    maximum
        Greatest value.
    """

    name: str
    symbol: str
    unit: str
    minimum: ExtremeAnswer
    maximum: ExtremeAnswer


class ExtremeAnswer(Record):
    """Extreme value of a coefficient.

    Attributes
    ----------
    value
        Extreme value.
    at
        Place of the extreme: SI values by the names of the uncertain numbers.
    """

    value: float
    at: Mapping[str, float]


VisitedEvidence: TypeAlias = Literal["search"]
"""Evidence for the visited ranges."""


class ReplacedRangeAnswer(Record):
    """Range that the project states as replaced by its family, and the range that the family visits.

    Attributes
    ----------
    symbol
        Symbol of the coefficient.
    unit
        SI unit of its values.
    replaced
        Replaced range, from low to high.
    visited
        Visited range, from low to high.
    fraction
        Fraction of the replaced range that is visited, of its logarithm where it is spaced by
        equal factors.
    beyond
        True if the family goes below the replaced range, and above it.
    """

    symbol: str
    unit: str
    replaced: Interval
    visited: Interval
    fraction: float
    beyond: tuple[bool, bool]


class CheckedRequirementAnswer(Record):
    """Requirement in time of a tracking limit, with the response that the limit itself has.

    Attributes
    ----------
    specification
        Number of the specification, from 1 in the order of the file.
    limit
        Key of the limit.
    required
        Required step response.
    reached
        Step response of the limit.
    met
        True if the limit satisfies the requirement.
    """

    specification: int
    limit: str
    required: RequiredResponseAnswer
    reached: ReachedStepAnswer
    met: bool


class RequiredResponseAnswer(Record):
    """Step response.

    Attributes
    ----------
    overshoot_percent
        Overshoot, of the step.
    settling_time_s
        Settling time; null if the response does not settle.
    settling_band_percent
        Band in which the response has settled, of the step.
    """

    overshoot_percent: float
    settling_time_s: float | None
    settling_band_percent: float


class ReachedStepAnswer(Record):
    """Step response of a limit.

    Attributes
    ----------
    overshoot_percent
        Overshoot, of the step.
    settling_time_s
        Settling time; null if the response does not settle.
    settling_band_percent
        Band in which the response has settled, of the step.
    reason
        Reason for which there is no settling time.
    """

    overshoot_percent: float
    settling_time_s: float | None
    settling_band_percent: float
    reason: str | None


class ImpossibleAnswer(Record):
    """Requirement that no loop can satisfy, in JSON.

    Attributes
    ----------
    key
        Key of the project file.
    line
        Line of the key in the file, from 1.
    sentence
        Sentence with the plant and the frequency that forbid it.
    remedy
        Change that would satisfy it.
    """

    key: str
    line: int
    sentence: str
    remedy: str


class SizeAnswer(Answer):
    """Answer of `size`.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    maximum_flow_m3_per_s
        Largest flow of a line.
    maximum_flow_limit
        Component that limits the largest flow.
    valve_flow_m3_per_s
        Largest flow of a line that the valve passes.
    pump_flow_m3_per_s
        Flow of the pump, if it is stated.
    bore_range_m
        Bores at the highest and at the lowest recommended oil velocity.
    pole_gain_v_per_n
        Proportional gain at which the time constant requires an infinite hydraulic stiffness.
    load
        Load in the model that is sized with.
    load_stiffness_n_per_m
        Stiffness of the load at the rod, only of a load in series.
    warnings
        Declared effects that the procedure does not include.
    bores
        Bores on the market, ascending.
    candidates
        Hoses with their lengths and gains: accepted ones first, then those that nothing
        rejects, among these the stiffness model of the project first, then the shorter ones.
    decisions
        Decisions of the procedure in order.
    influences
        Influence of uncertain numbers on the best candidate of the stiffness model of the
        project.
    other_means
        Other means with the stiffness of the best hose, if `[sizing.other_means]` requests them
        and a hose is accepted.
    """

    schema: int
    version: str
    command: Literal["size"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    maximum_flow_m3_per_s: float
    maximum_flow_limit: FlowLimit
    valve_flow_m3_per_s: float
    pump_flow_m3_per_s: float | None
    bore_range_m: Interval
    pole_gain_v_per_n: float
    load: SizedLoad
    load_stiffness_n_per_m: float | None
    warnings: tuple[str, ...] | None
    bores: tuple[SizedBoreAnswer, ...]
    candidates: tuple[CandidateAnswer, ...]
    decisions: tuple[SizingDecisionAnswer, ...]
    influences: tuple[InfluenceAnswer, ...]
    other_means: OtherMeansAnswer | None


FlowLimit: TypeAlias = Literal["valve", "pump"]
"""Component that limits the largest flow."""


SizedLoad: TypeAlias = Literal["prescribed", "in_series", "held_still"]
"""Load in the first-order model: its motion is prescribed, it yields in series with the sensor, or no stiffness holds it and the model holds it still."""


class SizedBoreAnswer(Record):
    """Bore on the market.

    Attributes
    ----------
    name
        Dash size or product.
    bore_m
        Bore of the hose.
    oil_velocity_m_per_s
        Mean oil velocity at the largest flow.
    verdict
        Verdict on the oil velocity.
    """

    name: str
    bore_m: float
    oil_velocity_m_per_s: float
    verdict: BoreVerdict


BoreVerdict: TypeAlias = Literal["recommended", "slow", "too_fast"]
"""Verdict on the oil velocity of a bore: within the recommended range, below it, or above it and thus rejected."""


class CandidateAnswer(Record):
    """Hose with its length and the proportional gain.

    Attributes
    ----------
    hose
        Name of the hose.
    compliance
        Stiffness model.
    branch
        Branch of the procedure.
    bore_m
        Bore of line A.
    length_m
        Length of line A; zero if no hose is needed.
    bore_b_m
        Bore of line B.
    length_b_m
        Length of line B.
    stiffness_n_per_m
        Least hydraulic stiffness over the stroke.
    stiffness_maximum_n_per_m
        Greatest hydraulic stiffness over the stroke.
    proportional_gain_v_per_n
        Proportional gain for the time constant at the least stiffness.
    oil_velocity_m_per_s
        Mean oil velocity at the largest flow.
    surge_pressure_pa
        Pressure surge if the largest flow is stopped at once.
    time_constant_s
        Time constant of the closed loop at the least and at the greatest stiffness over the
        stroke.
    steady_state_gain
        Steady-state gain of the closed loop at the null flow-pressure coefficient and at the
        largest one.
    accepted
        True if nothing rejects it and every number that is needed is known.
    reasons
        Reasons for and against it, those that reject it first.
    rejections
        Reasons that reject it.
    not_known
        Reasons that leave it open, as a number is not known.
    warnings
        Reasons that only warn of it.
    iterations
        Trials of the gain, only of the branch by gain.
    """

    hose: str
    compliance: StiffnessModel
    branch: SizingBranch
    bore_m: float
    length_m: float
    bore_b_m: float
    length_b_m: float
    stiffness_n_per_m: float
    stiffness_maximum_n_per_m: float
    proportional_gain_v_per_n: float
    oil_velocity_m_per_s: float
    surge_pressure_pa: float
    time_constant_s: tuple[float, float]
    steady_state_gain: tuple[float, float]
    accepted: bool
    reasons: tuple[str, ...]
    rejections: tuple[str, ...]
    not_known: tuple[str, ...]
    warnings: tuple[str, ...]
    iterations: tuple[GainTrialAnswer, ...]


StiffnessModel: TypeAlias = Literal["uniform", "by_volume"]
"""Stiffness model: one bulk modulus for line and chamber, or one of each volume."""


SizingBranch: TypeAlias = Literal["by_gain", "by_length"]
"""Branch of the procedure: the gain is given or searched for, or the length is given."""


class GainTrialAnswer(Record):
    """Trial of a gain.

    Attributes
    ----------
    proportional_gain_v_per_n
        Proportional gain.
    stiffness_n_per_m
        Hydraulic stiffness that the time constant requires; `inf` if no stiffness suffices.
    length_m
        Length of line A with this stiffness; zero if no hose is needed.
    """

    proportional_gain_v_per_n: float
    stiffness_n_per_m: float
    length_m: float


class SizingDecisionAnswer(Record):
    """Decision of the procedure.

    Attributes
    ----------
    step
        Letter of the step in the flowchart of the thesis.
    text
        Sentence on the decision.
    """

    step: str
    text: str


class InfluenceAnswer(Record):
    """Influence of an uncertain number, all others being nominal.

    Attributes
    ----------
    quantity
        Uncertain number.
    values
        Low, nominal and high value in SI.
    stiffness_n_per_m
        Least hydraulic stiffness over the stroke at the low, nominal and high value.
    length_m
        Length of line A that keeps the nominal stiffness at the low, nominal and high value;
        zero if no hose is needed.
    """

    quantity: UncertainHoseNumber
    values: tuple[float, float, float]
    stiffness_n_per_m: tuple[float, float, float]
    length_m: tuple[float, float, float]


UncertainHoseNumber: TypeAlias = Literal["dynamic stiffening r_\u03b2", "fluid bulk modulus \u03b2_0", "volumetric expansion E"]
"""Uncertain number, with its symbol."""


class OtherMeansAnswer(Record):
    """Other means with the stiffness of a hose.

    Attributes
    ----------
    stiffness_n_per_m
        Hydraulic stiffness that is required of them.
    chambers_n_per_m
        Least hydraulic stiffness over the stroke of the chambers without lines.
    actuator_length_m
        Retracted length of the actuator from mount to mount, without the spring; null if
        `cylinder.dead_length` is not stated.
    pipe
        Pipe to each chamber.
    pipe_reason
        Reason for which the value is absent.
    gas
        Equal accumulators at both chambers.
    gas_reason
        Reason for which the value is absent.
    spring
        Spring between force sensor and load.
    spring_reason
        Reason for which the value is absent.
    valves
        Laminar valve between the chambers: of the rig as declared, and of its chambers without
        lines.
    valves_reason
        Reason for which the value is absent.
    """

    stiffness_n_per_m: float
    chambers_n_per_m: float
    actuator_length_m: float | None
    pipe: SizedPipeAnswer | None
    pipe_reason: str | None
    gas: SizedGasAnswer | None
    gas_reason: str | None
    spring: SizedSpringAnswer | None
    spring_reason: str | None
    valves: tuple[SizedValveAnswer, SizedValveAnswer] | None
    valves_reason: str | None


class SizedPipeAnswer(Record):
    """Pipe to each chamber.

    Attributes
    ----------
    bore_m
        Bore of the pipe, that of the hose.
    length_m
        Length of each pipe.
    oil_m3
        Volume of the oil in both pipes.
    """

    bore_m: float
    length_m: float
    oil_m3: float


class SizedGasAnswer(Record):
    """Equal accumulators at both chambers.

    Attributes
    ----------
    gas_volume_m3
        Gas volume of each accumulator at its precharge.
    precharge_pressure_pa
        Gauge pressure of the precharge.
    pressure_ratio
        Ratio of the supply pressure to the precharge, both absolute.
    stiffness_n_per_m
        Softest and stiffest of the least hydraulic stiffnesses over the stroke, within the
        range of forces.
    """

    gas_volume_m3: float
    precharge_pressure_pa: float
    pressure_ratio: float
    stiffness_n_per_m: Interval


class SizedSpringAnswer(Record):
    """Spring between force sensor and load.

    Attributes
    ----------
    stiffness_n_per_m
        Stiffness of the spring.
    travel_m
        Travel to either side under the stall force.
    installed_length_m
        Length of both coil springs in their housing, at rest; null if the coils are not known.
    mass_kg
        Mass of both coil springs; null if the coils are not known.
    actuator_length_m
        Retracted length of the actuator with the spring, from mount to mount; null if it is not
        known.
    """

    stiffness_n_per_m: float
    travel_m: float
    installed_length_m: float | None
    mass_kg: float | None
    actuator_length_m: float | None


class SizedValveAnswer(Record):
    """Laminar valve between the chambers, which damps the mode of the load cell.

    Attributes
    ----------
    stiffness_n_per_m
        Hydraulic stiffness of the rig that it damps.
    damping_ratio_without_valve
        Damping ratio without the valve.
    conductance_m3_per_s_pa
        Conductance with the required damping ratio; null if none has it.
    damping_ratio_at_most
        Greatest damping ratio of all conductances.
    at_conductance_m3_per_s_pa
        Conductance with the greatest damping ratio.
    loss_w
        Loss of the valve at the greatest force of the range; null if no range is stated.
    """

    stiffness_n_per_m: float
    damping_ratio_without_valve: float
    conductance_m3_per_s_pa: float | None
    damping_ratio_at_most: float
    at_conductance_m3_per_s_pa: float
    loss_w: float | None


class LinearizeAnswer(Answer):
    """Answer of `linearize`.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    stiffness
        Hydraulic stiffness over the stroke.
    poles
        Poles of the linear models from the command to the force.
    load_held_still_in
        Models in which the load is held still, only if the load yields to force.
    plant
        Transfer functions of the plant of every verdict.
    linkage
        Linkage at selected positions over the stroke, if the rig has one.
    agreement
        Frequency bands in which each reduced model agrees with the plant to 1 dB and 5 degrees,
        the fullest model first.
    decomposition_error
        Difference of the corrected decomposed model (thesis 6.12) from the fifth-order one
        (6.7).
    reduction_error
        Difference of the fifth-order model from the two-pressure one, both with derived
        parameters.
    first_order_error
        Difference of the first-order model (thesis 6.13) from the fifth-order one (6.7), both
        with the load held still.
    dominance
        Modes of the plant with their parts in its step response.
    impedance
        Driving-point impedance at the load, -F_e/(s X_L).
    passivity
        Passivity of the driving-point impedance.
    virtual_impedance
        Virtual impedance compared with the impedance of the loop, only with
        `[controller.impedance]`.
    compliance_hidden_above_rad_per_s
        Frequency above which the mass of the piston, or the oil of a transmission, hides the
        compliance from the load.
    load_step_final_force_n
        Force or torque that remains after a step of the position by 0.001 (m or rad).
    load_step_final_torque_n_m
        Force or torque that remains after a step of the position by 0.001 (m or rad).
    load_step_moves
        Body that this step moves.
    warnings
        Declared effects that the linear models do not include.
    swept
        Swept key, if a sweep was requested.
    sweep
        Results at each value of the swept key, if a sweep was requested.
    """

    schema: int
    version: str
    command: Literal["linearize"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    stiffness: LinearStiffnessAnswer
    poles: ModelPolesAnswer
    load_held_still_in: tuple[HeldModel, ...] | None
    plant: LinearPlantAnswer
    linkage: tuple[LinkagePlaceAnswer, ...] | None
    agreement: tuple[AgreementBandsAnswer, ...]
    decomposition_error: DecompositionErrorAnswer
    reduction_error: ResponseDifferenceAnswer
    first_order_error: ResponseDifferenceAnswer
    dominance: tuple[DominantModeAnswer, ...]
    impedance: ImpedancesAnswer
    passivity: PassivitiesAnswer
    virtual_impedance: VirtualImpedanceAnswer | None
    compliance_hidden_above_rad_per_s: float
    load_step_final_force_n: FinalForcesAnswer | None
    load_step_final_torque_n_m: FinalForcesAnswer | None
    load_step_moves: MovedByStep
    warnings: tuple[str, ...]
    swept: SweptKeyAnswer | None
    sweep: tuple[SweptPointAnswer, ...] | None


class LinearStiffnessAnswer(Record):
    """Hydraulic stiffness over the stroke.

    Attributes
    ----------
    minimum_n_per_m
        Least stiffness, with the nominal wall of the lines.
    minimum_n_m_per_rad
        Least stiffness, with the nominal wall of the lines.
    maximum_n_per_m
        Greatest stiffness, with the nominal wall of the lines.
    maximum_n_m_per_rad
        Greatest stiffness, with the nominal wall of the lines.
    minimum_position_m
        Position or angle of the least stiffness, from the end of chamber A.
    minimum_angle_rad
        Position or angle of the least stiffness, from the end of chamber A.
    minimum_softest_wall_n_per_m
        Least stiffness with the softest wall of the uncertain lines.
    minimum_softest_wall_n_m_per_rad
        Least stiffness with the softest wall of the uncertain lines.
    maximum_stiffest_wall_n_per_m
        Greatest stiffness with the stiffest wall of the uncertain lines.
    maximum_stiffest_wall_n_m_per_rad
        Greatest stiffness with the stiffest wall of the uncertain lines.
    uniform
        Least and greatest stiffness in N/m or N m/rad, with one bulk modulus for line and
        chamber.
    by_volume
        Least and greatest stiffness in N/m or N m/rad, with a bulk modulus of each volume.
    sentence
        Sentence that compares the two stiffness models.
    """

    minimum_n_per_m: float | None
    minimum_n_m_per_rad: float | None
    maximum_n_per_m: float | None
    maximum_n_m_per_rad: float | None
    minimum_position_m: float | None
    minimum_angle_rad: float | None
    minimum_softest_wall_n_per_m: float | None
    minimum_softest_wall_n_m_per_rad: float | None
    maximum_stiffest_wall_n_per_m: float | None
    maximum_stiffest_wall_n_m_per_rad: float | None
    uniform: Interval
    by_volume: Interval
    sentence: str


class ModelPolesAnswer(Record):
    """Poles of the linear models from the command to the force, sorted by magnitude.

    Attributes
    ----------
    plant
        Plant of every verdict, with its load and the parameters in use.
    full
        Fifth-order model (thesis 6.7) with the parameters in use.
    full_derived
        Fifth-order model (thesis 6.7) with derived parameters.
    decomposed
        Decomposed model (thesis 6.12) with the damping corrected.
    decomposed_as_printed
        Decomposed model as the thesis prints it.
    first_order
        First-order model (thesis 6.13).
    two_pressure
        Linearised two-pressure model with derived parameters.
    """

    plant: tuple[complex, ...]
    full: tuple[complex, ...]
    full_derived: tuple[complex, ...]
    decomposed: tuple[complex, ...]
    decomposed_as_printed: tuple[complex, ...]
    first_order: tuple[complex, ...]
    two_pressure: tuple[complex, ...]


HeldModel: TypeAlias = Literal["two_pressure", "full", "decomposed", "first_order"]
"""Model that holds the load still, by its key in `poles`."""


class LinearPlantAnswer(Record):
    """Transfer functions of the plant, to the measured force.

    Attributes
    ----------
    command
        From the command of the valve.
    load_position
        From the position of the load, or of the ground of a load that yields.
    """

    command: FactorsAnswer
    load_position: FactorsAnswer


class FactorsAnswer(Record):
    """Transfer function gain (s - zeros).../((s - poles)...).

    Attributes
    ----------
    gain
        Leading coefficient.
    zeros
        Zeros, sorted by magnitude.
    poles
        Poles, sorted by magnitude.
    """

    gain: float
    zeros: tuple[complex, ...]
    poles: tuple[complex, ...]


class LinkagePlaceAnswer(Record):
    """Linkage at one position, which joins the rod of a cylinder.

    Attributes
    ----------
    at
        Name of the position.
    position_m
        Position of the end of the rod from the start of the stroke.
    angle_rad
        Angle of the joint.
    lever_arm_m
        Lever arm: torque over force, and velocity over angular velocity.
    reflected_mass_kg
        Inertia of the load over the square of the lever arm, only of a load that yields.
    """

    at: LinkagePosition
    position_m: float
    angle_rad: float
    lever_arm_m: float
    reflected_mass_kg: float | None


LinkagePosition: TypeAlias = Literal["retracted", "extended", "operating point", "least lever arm", "greatest lever arm"]
"""Position of a linkage."""


class AgreementBandsAnswer(Record):
    """Frequency bands in which a reduced model is within 1 dB and 5 degrees of the plant.

    Attributes
    ----------
    model
        Name of the reduced model.
    equation
        Equation of the reduced model in the thesis.
    bands_rad_per_s
        Bands from the lower to the upper frequency, ascending, as resolved by the grid.
    """

    model: str
    equation: str
    bands_rad_per_s: tuple[Interval, ...]


class DecompositionErrorAnswer(Record):
    """Differences of the decomposed model from the fifth-order one.

    Attributes
    ----------
    magnitude_db
        Largest difference of the magnitudes, positive.
    magnitude_at_rad_per_s
        Frequency of the largest difference of the magnitudes.
    phase_deg
        Largest difference of the phases, from 0 to 180.
    phase_at_rad_per_s
        Frequency of the largest difference of the phases.
    below_1000_rad_per_s
        Largest differences at frequencies below 1000 rad/s.
    as_printed
        Differences of the decomposed model as the thesis prints it.
    """

    magnitude_db: float
    magnitude_at_rad_per_s: float
    phase_deg: float
    phase_at_rad_per_s: float
    below_1000_rad_per_s: LowDifferenceAnswer
    as_printed: ResponseDifferenceAnswer


class LowDifferenceAnswer(Record):
    """Largest differences of the responses of two models below 1000 rad/s.

    Attributes
    ----------
    magnitude_db
        Largest difference of the magnitudes, positive.
    phase_deg
        Largest difference of the phases, from 0 to 180.
    """

    magnitude_db: float
    phase_deg: float


class ResponseDifferenceAnswer(Record):
    """Largest differences of the responses of two models over frequency.

    Attributes
    ----------
    magnitude_db
        Largest difference of the magnitudes, positive.
    magnitude_at_rad_per_s
        Frequency of the largest difference of the magnitudes.
    phase_deg
        Largest difference of the phases, from 0 to 180.
    phase_at_rad_per_s
        Frequency of the largest difference of the phases.
    below_1000_rad_per_s
        Largest differences at frequencies below 1000 rad/s.
    """

    magnitude_db: float
    magnitude_at_rad_per_s: float
    phase_deg: float
    phase_at_rad_per_s: float
    below_1000_rad_per_s: LowDifferenceAnswer


class DominantModeAnswer(Record):
    """Mode of the plant in its step response.

    Attributes
    ----------
    pole
        Pole, of a conjugate pair the one with positive imaginary part.
    step_fraction
        Greatest amplitude of the mode in the step response, of the final value; null if it does
        not exist.
    decay_ratio
        Ratio of the decay rate to that of the slowest mode; null if it does not exist.
    reason
        Reason for a number that does not exist, only in that case.
    """

    pole: complex
    step_fraction: float | None
    decay_ratio: float | None
    reason: str | None


class ImpedancesAnswer(Record):
    """Driving-point impedances at the load, -F_e/(s X_L).

    Attributes
    ----------
    open_loop
        Impedance with constant command.
    closed_loop
        Impedance with the given controller.
    closed_loop_reason
        Reason for which the value is absent.
    """

    open_loop: ImpedanceAnswer
    closed_loop: ImpedanceAnswer | None
    closed_loop_reason: str | None


class ImpedanceAnswer(Record):
    """Driving-point impedance as a transfer function, with its asymptotes.

    Attributes
    ----------
    gain
        Leading coefficient.
    zeros
        Zeros, sorted by magnitude.
    poles
        Poles, sorted by magnitude.
    asymptotes
        Asymptotes in the order of frequency.
    """

    gain: float
    zeros: tuple[complex, ...]
    poles: tuple[complex, ...]
    asymptotes: tuple[AsymptoteAnswer, ...]


class AsymptoteAnswer(Record):
    """Asymptote Z = coefficient s^power of an impedance.

    Attributes
    ----------
    kind
        Origin of the asymptote.
    coefficient
        Mass, damping or stiffness, by the power.
    power
        Power of s: 1 for a mass, 0 for a damper, -1 for a spring.
    from_rad_per_s
        Lower end of the range in which it is the nearest asymptote.
    to_rad_per_s
        Upper end of this range.
    """

    kind: AsymptoteKind
    coefficient: float
    power: int
    from_rad_per_s: float
    to_rad_per_s: float


AsymptoteKind: TypeAlias = Literal["low_frequency", "compliance_plateau", "sensor_limit", "oil_limit"]
"""Origin of an asymptote of an impedance: the loop or the leakage of the valve at low frequency, the compliance of fluid and sensor in series, the sensor alone in front of a piston at rest, or the last spring of a transmission whose oil is at rest."""


class PassivitiesAnswer(Record):
    """Passivity of the driving-point impedances at the load.

    Attributes
    ----------
    open_loop
        Passivity with constant command.
    closed_loop
        Passivity with the given controller.
    closed_loop_reason
        Reason for which the value is absent.
    """

    open_loop: PassivityAnswer
    closed_loop: PassivityAnswer | None
    closed_loop_reason: str | None


class PassivityAnswer(Record):
    """Passivity of a driving-point impedance Z.

    Attributes
    ----------
    passive
        True if Z is passive.
    right_half_plane_poles
        Poles of Z in the right half plane.
    imaginary_poles
        Frequencies of the poles of Z on the imaginary axis, in rad/s.
    bands
        Bands from the lower to the upper frequency in rad/s in which Re Z is negative.
    """

    passive: bool
    right_half_plane_poles: tuple[complex, ...]
    imaginary_poles: tuple[float, ...]
    bands: tuple[Interval, ...]


class VirtualImpedanceAnswer(Record):
    """Virtual impedance that is required of the port, compared with the impedance of the loop.

    Attributes
    ----------
    stiffness_n_per_m
        Virtual stiffness K_v.
    stiffness_n_m_per_rad
        Virtual stiffness K_v.
    damping_n_s_per_m
        Virtual damping B_v.
    damping_n_m_s_per_rad
        Virtual damping B_v.
    mass_kg
        Virtual mass or inertia M_v.
    inertia_kg_m2
        Virtual mass or inertia M_v.
    filter_time_s
        Time constant of the filter of the measured position.
    within_percent
        Difference, of the required impedance, up to which the impedance of the loop follows it.
    follows_rad_per_s
        Widest band, from the lower to the upper frequency, in which the impedance of the loop
        follows the required one.
    follows_rad_per_s_reason
        Reason for which the value is absent.
    points
        Both impedances at selected frequencies.
    """

    stiffness_n_per_m: float | None
    stiffness_n_m_per_rad: float | None
    damping_n_s_per_m: float | None
    damping_n_m_s_per_rad: float | None
    mass_kg: float | None
    inertia_kg_m2: float | None
    filter_time_s: float
    within_percent: float
    follows_rad_per_s: Interval | None
    follows_rad_per_s_reason: str | None
    points: tuple[VirtualImpedancePointAnswer, ...]


class VirtualImpedancePointAnswer(Record):
    """Required impedance and that of the loop at one frequency.

    Attributes
    ----------
    frequency_rad_per_s
        Frequency of the comparison.
    required_n_s_per_m
        Magnitude of the required impedance M_v s + B_v + K_v/s.
    required_n_m_s_per_rad
        Magnitude of the required impedance M_v s + B_v + K_v/s.
    achieved_n_s_per_m
        Magnitude of the impedance of the loop.
    achieved_n_m_s_per_rad
        Magnitude of the impedance of the loop.
    required_complex_n_s_per_m
        Required impedance, real and imaginary part.
    required_complex_n_m_s_per_rad
        Required impedance, real and imaginary part.
    achieved_complex_n_s_per_m
        Impedance -F_e/(s X_L) of the loop, real and imaginary part.
    achieved_complex_n_m_s_per_rad
        Impedance -F_e/(s X_L) of the loop, real and imaginary part.
    phase_difference_deg
        Phase of the impedance of the loop less that of the required one, within half a turn.
    """

    frequency_rad_per_s: float
    required_n_s_per_m: float | None
    required_n_m_s_per_rad: float | None
    achieved_n_s_per_m: float | None
    achieved_n_m_s_per_rad: float | None
    required_complex_n_s_per_m: complex | None
    required_complex_n_m_s_per_rad: complex | None
    achieved_complex_n_s_per_m: complex | None
    achieved_complex_n_m_s_per_rad: complex | None
    phase_difference_deg: float


class FinalForcesAnswer(Record):
    """Force or torque that remains after a step of the position by 0.001.

    Attributes
    ----------
    open_loop
        Value with constant command.
    open_loop_reason
        Reason for which the value is absent.
    closed_loop
        Value with the given controller.
    closed_loop_reason
        Reason for which the value is absent.
    """

    open_loop: float | None
    open_loop_reason: str | None
    closed_loop: float | None
    closed_loop_reason: str | None


MovedByStep: TypeAlias = Literal["ground", "load"]
"""Body that a step of the position moves: the load, or the ground of a load that yields."""


class SweptKeyAnswer(Record):
    """Swept key of the project.

    Attributes
    ----------
    key
        Path of the key.
    unit
        Unit of the values.
    points
        Number of values.
    spacing
        Spacing of the values.
    plant_follows
        True if the plant of every verdict depends on the key; otherwise poles, resonance and
        bandwidth are those of the derived parameters.
    """

    key: str
    unit: str
    points: int
    spacing: SweepSpacing
    plant_follows: bool


SweepSpacing: TypeAlias = Literal["log", "linear"]
"""Spacing of the values of a sweep: by ratio or by difference."""


class SweptPointAnswer(Record):
    """Linear models at one value of the swept key; null where there are none.

    Attributes
    ----------
    value
        Value of the swept key.
    stiffness
        Hydraulic stiffness over the stroke, with the nominal wall of the lines.
    poles
        Poles from the command to the force.
    resonance
        Resonance of the least damped pole; null if no pole has one.
    bandwidth_rad_per_s
        Frequency up to which the force of the nominal loop stays within 3 dB of its value
        towards zero frequency, with the given controller.
    bandwidth_rad_per_s_reason
        Reason for which there is no bandwidth, only if there are linear models.
    passive
        Passivity of the driving-point impedance at the load.
    reason
        Reason for which there are no linear models, only in that case.
    """

    value: float
    stiffness: SweptStiffnessAnswer | None
    poles: SweptPolesAnswer | None
    resonance: SweptResonanceAnswer | None
    bandwidth_rad_per_s: float | None
    bandwidth_rad_per_s_reason: str | None
    passive: SweptPassivityAnswer | None
    reason: str | None


class SweptStiffnessAnswer(Record):
    """Hydraulic stiffness over the stroke.

    Attributes
    ----------
    minimum_n_per_m
        Least stiffness.
    minimum_n_m_per_rad
        Least stiffness.
    maximum_n_per_m
        Greatest stiffness.
    maximum_n_m_per_rad
        Greatest stiffness.
    """

    minimum_n_per_m: float | None
    minimum_n_m_per_rad: float | None
    maximum_n_per_m: float | None
    maximum_n_m_per_rad: float | None


class SweptPolesAnswer(Record):
    """Poles from the command to the force.

    Attributes
    ----------
    plant
        Plant of every verdict, with the parameters in use.
    derived
        Plant with the derived parameters.
    """

    plant: tuple[complex, ...]
    derived: tuple[complex, ...]


class SweptResonanceAnswer(Record):
    """Resonance of a pole.

    Attributes
    ----------
    frequency_rad_per_s
        Magnitude of the pole.
    damping_ratio
        Damping ratio of the pole, negative if it is unstable.
    """

    frequency_rad_per_s: float
    damping_ratio: float


class SweptPassivityAnswer(Record):
    """Passivity of the driving-point impedance at the load.

    Attributes
    ----------
    open_loop
        True if the impedance is passive with constant command.
    closed_loop
        True if the impedance is passive with the given controller; null if it is not computed.
    """

    open_loop: bool
    closed_loop: bool | None


class VerifyAnswer(Answer):
    """Answer of `verify`.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    verdict
        Verdict on stability and all specifications.
    evidence
        Weakest evidence behind the verdict.
    tolerance_db
        Violation that still counts as met.
    stable
        True if every plant of the family is stable in the loop.
    stable_reason
        Reason for which the value is absent.
    stability
        Stability of the family.
    proof
        Proof of stability over the box, if a proof was requested.
    delay_margin_s
        Least additional delay that makes a plant of the family unstable.
    delay_margin_s_reason
        Reason for which the value is absent.
    delay_margin
        Place of the delay margin.
    gain_reduction_db
        Factor to which the gain of the nominal loop may fall, negative; `-inf` if it may
        vanish.
    gain_reduction_db_reason
        Reason for which the value is absent.
    margins
        Margins of the nominal loop and the worst of the family.
    members
        Number of plants of the family.
    position
        Position of every plant, only if all plants have it and a rig is declared.
    parameters
        Names of the parameters of a plant, in the order of the tables in files.
    timing
        Sampling and delay of the loop.
    velocity_noise
        Noise of the load velocity that is fed forward, if a sensor measures it.
    pressure_noise
        Noise of the pressures that are fed back, if any.
    amplifying_prefilter
        Gain of the prefilter, only if it amplifies.
    specifications
        Findings in the order of the specifications in the file; those without a number in the
        file, such as a limit on rounding, are last.
    warnings
        Declared effects that the audit does not include.
    below_design
        Limits of a design that the loop exceeds, which are no part of the verdict.
    satisfied_limits_of_design
        Limits of a design that the loop satisfies.
    impossible
        Requirements that no loop can satisfy.
    machine
        Verdict tested on the nonlinear machine, if requested.
    """

    schema: int
    version: str
    command: Literal["verify"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    verdict: Verdict
    evidence: Evidence
    tolerance_db: float
    stable: bool | None
    stable_reason: str | None
    stability: StabilityAnswer
    proof: AuditProofAnswer | None
    delay_margin_s: float | None
    delay_margin_s_reason: str | None
    delay_margin: DelayMarginAnswer | None
    gain_reduction_db: float | None
    gain_reduction_db_reason: str | None
    margins: AuditMarginsAnswer
    members: int
    position: CommonPositionAnswer | None
    parameters: tuple[str, ...]
    timing: TimingAnswer
    velocity_noise: VelocityNoiseAnswer | None
    pressure_noise: PressureNoiseAnswer | None
    amplifying_prefilter: AmplifyingPrefilterAnswer | None
    specifications: tuple[AuditedSpecification, ...]
    warnings: tuple[str, ...]
    below_design: tuple[ExceededLimitAnswer, ...] | None
    satisfied_limits_of_design: tuple[DesignLimitKind, ...] | None
    impossible: tuple[ImpossibleAnswer, ...]
    machine: TrialAnswer | None


Verdict: TypeAlias = Literal["met", "violated", "not_proven"]
"""Verdict on a requirement: satisfied by every plant, violated by one, or not resolved."""


Evidence: TypeAlias = Literal["grid", "search", "proof"]
"""Evidence for a verdict: plants and frequencies one by one, a search for the worst case over the box and the band, or a proof for every plant and frequency."""


class StabilityAnswer(Record):
    """Stability of the family in the loop.

    Attributes
    ----------
    verdict
        Verdict on stability.
    evidence
        Evidence for the verdict.
    largest_real_part_per_s
        Largest real part of a closed-loop pole, ln|z|/T in a sampled loop; null if the poles
        are not available.
    plant
        Plant with this pole, or that is unstable, or that could not be resolved.
    reason
        Reason for the verdict.
    leading_coefficient
        Leading coefficient of the characteristic equation, if a search had to find its least
        value: while its sign is constant, no pole passes through infinity.
    """

    verdict: Verdict
    evidence: Evidence
    largest_real_part_per_s: float | None
    plant: Plant
    reason: str
    leading_coefficient: LeadingCoefficientAnswer | None


Plant: TypeAlias = Mapping[str, float | str]
"""Plant of a family: SI values by the names of the parameters; of a measured plant its name."""


class LeadingCoefficientAnswer(Record):
    """Least leading coefficient of the characteristic equation that a search found in the box.

    Attributes
    ----------
    least_fraction_of_nominal
        Ratio of the least value to the value of the nominal plant.
    plant
        Plant with the least value.
    parameters
        Parameters that change it, the most important first.
    """

    least_fraction_of_nominal: float
    plant: Plant
    parameters: tuple[str, ...]


class AuditProofAnswer(Record):
    """Proof over the box.

    Attributes
    ----------
    stable
        Proof of stability.
    leaves
        Number of boxes of the certificate.
    """

    stable: ProvenAnswer
    leaves: int


class ProvenAnswer(Record):
    """Outcome of the proof of a claim.

    Attributes
    ----------
    proven
        True if the claim is proven, false if it is refuted.
    proven_reason
        Reason for which the value is absent.
    """

    proven: bool | None
    proven_reason: str | None


class DelayMarginAnswer(Record):
    """Place of the delay margin.

    Attributes
    ----------
    frequency_rad_per_s
        Gain crossover at which the loop becomes unstable.
    plant
        Plant that becomes unstable.
    """

    frequency_rad_per_s: float
    plant: Plant


class AuditMarginsAnswer(Record):
    """Margins of the nominal loop and the worst of the family, which is also in front.

    Attributes
    ----------
    gain_db
        Worst factor by which the gain may grow; `inf` if nothing limits it.
    gain_db_reason
        Reason for which the value is absent.
    gain_reduction_db
        Worst factor to which the gain may fall, negative; `-inf` if it may vanish.
    gain_reduction_db_reason
        Reason for which the value is absent.
    phase_deg
        Worst angle between L and -1 where |L| = 1: positive if a lag makes the loop unstable,
        negative if a lead does.
    phase_deg_reason
        Reason for which the value is absent.
    modulus
        Least |1 + L|.
    modulus_reason
        Reason for which the value is absent.
    delay_s
        Least additional dead time that brings L to -1.
    delay_s_reason
        Reason for which the value is absent.
    evidence
        Evidence for the worst of the family.
    plants
        Number of examined plants.
    nominal
        Margins of the nominal loop.
    nominal_reason
        Reason for which the value is absent.
    family
        Worst margins of the family, each with its place.
    family_reason
        Reason for which the value is absent.
    """

    gain_db: float | None
    gain_db_reason: str | None
    gain_reduction_db: float | None
    gain_reduction_db_reason: str | None
    phase_deg: float | None
    phase_deg_reason: str | None
    modulus: float | None
    modulus_reason: str | None
    delay_s: float | None
    delay_s_reason: str | None
    evidence: Evidence
    plants: int
    nominal: MarginSetAnswer | None
    nominal_reason: str | None
    family: MarginSetAnswer | None
    family_reason: str | None


class MarginSetAnswer(Record):
    """Margins of a loop, or the worst of each in a family.

    Attributes
    ----------
    gain_db
        Factor by which the gain may grow; `inf` if nothing limits it.
    gain_reduction_db
        Factor to which the gain may fall, negative; `-inf` if it may vanish.
    phase_deg
        Least angle between L and -1 where |L| = 1: positive if a lag makes the loop unstable,
        negative if a lead does.
    modulus
        Least |1 + L|.
    delay_s
        Least additional dead time that brings L to -1.
    at
        Place of each margin.
    """

    gain_db: float
    gain_reduction_db: float
    phase_deg: float
    modulus: float
    delay_s: float
    at: MarginPlacesAnswer


class MarginPlacesAnswer(Record):
    """Places of margins.

    Attributes
    ----------
    gain_db
        Place of the gain margin.
    gain_reduction_db
        Place of the margin to a fall of the gain.
    phase_deg
        Place of the phase margin.
    modulus
        Place of the modulus margin.
    delay_s
        Place of the delay margin.
    """

    gain_db: MarginPlaceAnswer
    gain_reduction_db: MarginPlaceAnswer
    phase_deg: MarginPlaceAnswer
    modulus: MarginPlaceAnswer
    delay_s: MarginPlaceAnswer


class MarginPlaceAnswer(Record):
    """Frequency and plant of a margin.

    Attributes
    ----------
    frequency_rad_per_s
        Frequency of the margin.
    frequency_rad_per_s_reason
        Reason for which the value is absent.
    plant
        Plant with the margin.
    """

    frequency_rad_per_s: float | None
    frequency_rad_per_s_reason: str | None
    plant: Plant


class CommonPositionAnswer(Record):
    """Position that no plant of the family varies.

    Attributes
    ----------
    position_m
        Position from the end of chamber A.
    angle_rad
        Position from the end of chamber A.
    stroke_m
        Length of the stroke.
    stroke_rad
        Length of the stroke.
    """

    position_m: float | None
    angle_rad: float | None
    stroke_m: float | None
    stroke_rad: float | None


class TimingAnswer(Record):
    """Sampling and delay of a loop.

    Attributes
    ----------
    sample_time_s
        Sample time of the controller.
    sample_time_s_reason
        Reason for which the value is absent.
    delay_s
        Delay of the loop in addition to sampling.
    """

    sample_time_s: float | None
    sample_time_s_reason: str | None
    delay_s: float


class VelocityNoiseAnswer(Record):
    """Noise of the load velocity that is fed forward, with its effects in a sampled loop.

    Attributes
    ----------
    rms_m_per_s
        Noise and rounding of the velocity together.
    rms_rad_per_s
        Noise and rounding of the velocity together.
    command_rms_v
        Effect on the command at the valve.
    command_rms_v_reason
        Reason for which the value is absent.
    command_plant
        Plant with this effect.
    force_rms_n
        Effect on the force or torque.
    torque_rms_n_m
        Effect on the force or torque.
    force_rms_n_reason
        Reason for which the value is absent.
    torque_rms_n_m_reason
        Reason for which the value is absent.
    force_plant
        Plant with this effect.
    """

    rms_m_per_s: float | None
    rms_rad_per_s: float | None
    command_rms_v: float | None
    command_rms_v_reason: str | None
    command_plant: Plant | None
    force_rms_n: float | None
    torque_rms_n_m: float | None
    force_rms_n_reason: str | None
    torque_rms_n_m_reason: str | None
    force_plant: Plant | None


class PressureNoiseAnswer(Record):
    """Noise of the pressures that are fed back, with its effects in a sampled loop.

    Attributes
    ----------
    rms_pa
        Noise of the pressure signal.
    command_rms_v
        Effect on the command at the valve.
    command_rms_v_reason
        Reason for which the value is absent.
    command_plant
        Plant with this effect.
    force_rms_n
        Effect on the force or torque.
    torque_rms_n_m
        Effect on the force or torque.
    force_rms_n_reason
        Reason for which the value is absent.
    torque_rms_n_m_reason
        Reason for which the value is absent.
    force_plant
        Plant with this effect.
    """

    rms_pa: float
    command_rms_v: float | None
    command_rms_v_reason: str | None
    command_plant: Plant | None
    force_rms_n: float | None
    torque_rms_n_m: float | None
    force_rms_n_reason: str | None
    torque_rms_n_m_reason: str | None
    force_plant: Plant | None


class AmplifyingPrefilterAnswer(Record):
    """Gain of a prefilter F that amplifies.

    Attributes
    ----------
    gain_at_zero
        Gain |F(0)|.
    largest_gain
        Largest |F|.
    rise_db
        Ratio of the largest gain to the one at zero frequency.
    frequency_rad_per_s
        Frequency of the largest gain.
    """

    gain_at_zero: float
    largest_gain: float
    rise_db: float
    frequency_rad_per_s: float


AuditedSpecification: TypeAlias = "SpecificationAnswer | StepSpecificationAnswer"
"""Finding on a specification."""


class SpecificationAnswer(Record):
    """Finding on a limit of a closed loop over frequency.

    Attributes
    ----------
    specification
        Number of the specification, from 1 in the order of the file; left out if it is no limit
        of the file.
    kind
        Kind of the specification.
    name
        Name of the specification, if it is not a limit of the file.
    verdict
        Verdict on the specification.
    evidence
        Evidence for the verdict.
    worst_margin_db
        Worst margin over the band and the family; negative if the specification is violated.
    frequency_rad_per_s
        Frequency of the worst margin; zero or `inf` for a limit towards it.
    plant
        Plant with the worst margin; of a spread the one with the greatest |T|.
    other_plant
        Plant with the least |T|, of a spread.
    reason
        Reason for which there is no margin.
    reached
        Magnitude of the worst plant and its limit.
    interior
        Worst margin inside the band, if the worst is at an end of the band: towards that end
        the margin may fall further.
    proven
        True if the claim is proven, false if it is refuted.
    proven_reason
        Reason for which the value is absent.
    enclosure_db
        Bounds of the greatest ratio of the closed loop to its limit, from low to high.
    enclosure_db_reason
        Reason for which a bound is absent.
    in_time
        Steps against the requirement in time from which the limit follows.
    violations
        Bands in which an examined plant violates it.
    at_design_frequencies
        Worst margin of the family at each design frequency.
    remarks
        Limitations of the examination.
    """

    specification: int | None
    kind: SpecificationKind
    name: str | None
    verdict: Verdict
    evidence: Evidence
    worst_margin_db: float | None
    frequency_rad_per_s: float | None
    plant: Plant | None
    other_plant: Plant | None
    reason: str | None
    reached: ReachedLimitAnswer | None
    interior: SpecificationMarginAnswer | None
    proven: bool | None
    proven_reason: str | None
    enclosure_db: tuple[float | None, float | None] | None
    enclosure_db_reason: str | None
    in_time: TimeFindingAnswer | None
    violations: tuple[ViolatedBandAnswer, ...]
    at_design_frequencies: tuple[SpecificationMarginAnswer, ...]
    remarks: tuple[str, ...]


SpecificationKind: TypeAlias = Literal["robust_stability", "sensitivity", "plant_input_disturbance", "control_effort", "load_motion", "tracking", "step"]
"""Kind of a specification, as in the project file."""


class ReachedLimitAnswer(Record):
    """Magnitude that a closed loop reaches, and the limit that it comes nearest to or violates.

    Attributes
    ----------
    magnitude
        Magnitude of the closed loop.
    limit
        Limit of the magnitude.
    """

    magnitude: float
    limit: float


class SpecificationMarginAnswer(Record):
    """Margin of a specification at a frequency.

    Attributes
    ----------
    frequency_rad_per_s
        Frequency; zero or `inf` for a limit towards it.
    margin_db
        Margin; negative if the specification is violated.
    plant
        Plant with the margin; of a spread the one with the greatest |T|.
    other_plant
        Plant with the least |T|, of a spread.
    """

    frequency_rad_per_s: float
    margin_db: float
    plant: Plant
    other_plant: Plant | None


class TimeFindingAnswer(Record):
    """Steps of the reference against a requirement in time.

    Attributes
    ----------
    verdict
        Verdict on the steps.
    verdict_reason
        Reason for which the value is absent.
    part_of_verdict
        True if the verdict of the audit includes this one.
    required
        Required step response.
    evidence
        Evidence for the verdict.
    plants
        Number of examined plants.
    worst_overshoot_percent
        Greatest overshoot, of the step, if one is required.
    overshoot_plant
        Plant with the greatest overshoot.
    worst_settling_time_s
        Longest settling time, `inf` if a step does not settle within the computed time, if one
        is required.
    settling_plant
        Plant with the longest settling time.
    worst_rise_time_s
        Longest rise from 10 to 90 percent, `inf` if a step does not rise within the computed
        time, if one is required.
    rise_plant
        Plant with the longest rise.
    """

    verdict: Verdict | None
    verdict_reason: str | None
    part_of_verdict: bool
    required: RequiredStepAnswer
    evidence: Evidence | None
    plants: int | None
    worst_overshoot_percent: float | None
    overshoot_plant: Plant | None
    worst_settling_time_s: float | None
    settling_plant: Plant | None
    worst_rise_time_s: float | None
    rise_plant: Plant | None


class RequiredStepAnswer(Record):
    """Required response to a step of the reference.

    Attributes
    ----------
    overshoot_percent
        Greatest overshoot, of the step.
    settling_time_s
        Longest settling time.
    rise_time_s
        Longest rise from 10 to 90 percent.
    settling_band_percent
        Band in which the response has settled, of the step.
    """

    overshoot_percent: float | None
    settling_time_s: float | None
    rise_time_s: float | None
    settling_band_percent: float


class ViolatedBandAnswer(Record):
    """Band in which an examined plant violates a specification.

    Attributes
    ----------
    band_rad_per_s
        Ends of the band.
    frequency_rad_per_s
        Frequency; zero or `inf` for a limit towards it.
    margin_db
        Margin; negative if the specification is violated.
    plant
        Plant with the margin; of a spread the one with the greatest |T|.
    other_plant
        Plant with the least |T|, of a spread.
    """

    band_rad_per_s: Interval
    frequency_rad_per_s: float
    margin_db: float
    plant: Plant
    other_plant: Plant | None


class StepSpecificationAnswer(Record):
    """Finding on a requirement on steps.

    Attributes
    ----------
    specification
        Number of the specification, from 1 in the order of the file.
    kind
        Kind of the specification, `step`.
    verdict
        Verdict on the steps.
    verdict_reason
        Reason for which the value is absent.
    part_of_verdict
        True if the verdict of the audit includes this one.
    required
        Required step response.
    evidence
        Evidence for the verdict.
    plants
        Number of examined plants.
    worst_overshoot_percent
        Greatest overshoot, of the step, if one is required.
    overshoot_plant
        Plant with the greatest overshoot.
    worst_settling_time_s
        Longest settling time, `inf` if a step does not settle within the computed time, if one
        is required.
    settling_plant
        Plant with the longest settling time.
    worst_rise_time_s
        Longest rise from 10 to 90 percent, `inf` if a step does not rise within the computed
        time, if one is required.
    rise_plant
        Plant with the longest rise.
    plant
        Plant of the property that is nearest to its limit or furthest beyond.
    """

    specification: int
    kind: SpecificationKind
    verdict: Verdict | None
    verdict_reason: str | None
    part_of_verdict: bool
    required: RequiredStepAnswer
    evidence: Evidence | None
    plants: int | None
    worst_overshoot_percent: float | None
    overshoot_plant: Plant | None
    worst_settling_time_s: float | None
    settling_plant: Plant | None
    worst_rise_time_s: float | None
    rise_plant: Plant | None
    plant: Plant | None


class ExceededLimitAnswer(Record):
    """Limit of a design that an audited loop exceeds.

    Attributes
    ----------
    key
        Limit in `[design]`.
    value
        Value of a ratio or gain.
    value_rad_per_s
        Value of a bandwidth or natural frequency.
    value_s
        Value of a delay.
    limit
        Limit of a ratio or gain.
    limit_rad_per_s
        Limit of a bandwidth or natural frequency.
    limit_s
        Limit of a delay.
    origin
        Origin of the limit.
    """

    key: DesignLimitKind
    value: float | None
    value_rad_per_s: float | None
    value_s: float | None
    limit: float | None
    limit_rad_per_s: float | None
    limit_s: float | None
    origin: LimitOrigin


DesignLimitKind: TypeAlias = Literal["noise_to_command", "modulus_margin", "highest_bandwidth", "minimum_delay_margin", "pole_damping_ratio", "fastest_pole", "prefilter_gain", "command_of_steps", "required_step"]
"""Limit of what may be built: its key in `[design]`, or a name of its own."""


LimitOrigin: TypeAlias = Literal["stated", "default", "quarter_wave", "servovalve", "sampling", "highest_bandwidth"]
"""Origin of the value of a limit."""


class TrialAnswer(Record):
    """Verdict of an audit tested on the nonlinear machine.

    Attributes
    ----------
    verdict
        Agreement of the machine with the verdict, the worst of all runs.
    requirements
        Outcome for the requirements in time, if there are any.
    runs
        Runs, each of a machine through steps of the reference.
    not_driven
        Machines and steps that were not simulated, with the reason.
    """

    verdict: Agreement
    requirements: Satisfaction | None
    runs: tuple[TrialRunAnswer, ...]
    not_driven: tuple[str, ...]


Agreement: TypeAlias = Literal["agrees", "agrees_but_for_settling", "differs", "contradicts"]
"""Agreement of a machine with its linear loop, best first."""


Satisfaction: TypeAlias = Literal["satisfies", "misses"]
"""Outcome of steps for a requirement in time."""


class TrialRunAnswer(Record):
    """Run of a machine through steps there, back and there again.

    Attributes
    ----------
    what
        Name of the machine and the size of its steps.
    plant
        Plant of the audit from which the machine was made, if any.
    status
        Status of the run.
    agrees
        True if the machine behaves as the linear loop predicts, except for its settling time.
    agreement
        Agreement of the machine with the linear loop.
    reason
        Reason for the agreement.
    reference_n
        Reference before and after the first step.
    reference_n_m
        Reference before and after the first step.
    step
        Size of the steps.
    worst_step
        Worst of the steps.
    remaining_amplitude_n
        Amplitude of an oscillation that remains: half the range of the force or torque over the
        last fifth of a step, the largest of all steps.
    remaining_amplitude_n_m
        Amplitude of an oscillation that remains: half the range of the force or torque over the
        last fifth of a step, the largest of all steps.
    remaining_amplitude_n_reason
        Reason for which the value is absent.
    remaining_amplitude_n_m_reason
        Reason for which the value is absent.
    linear
        Prediction of the linear loop.
    linear_reason
        Reason for which the value is absent.
    machine
        Greatest overshoot and longest settling time of the steps of the machine.
    machine_reason
        Reason for which the value is absent.
    steps
        Steps of the machine, the first alone if that is decisive.
    requirements
        Requirements in time of these steps.
    """

    what: str
    plant: Plant | None
    status: RunStatus
    agrees: bool
    agreement: Agreement
    reason: str
    reference_n: tuple[float, float] | None
    reference_n_m: tuple[float, float] | None
    step: StepSize
    worst_step: Leg
    remaining_amplitude_n: float | None
    remaining_amplitude_n_m: float | None
    remaining_amplitude_n_reason: str | None
    remaining_amplitude_n_m_reason: str | None
    linear: TrialStepAnswer | None
    linear_reason: str | None
    machine: TrialStepAnswer | None
    machine_reason: str | None
    steps: tuple[TrialLegAnswer, ...]
    requirements: tuple[HeldRequirementAnswer, ...]


RunStatus: TypeAlias = Literal["completed", "refused", "step_too_small", "not_finite", "too_many_steps", "unresolved_oscillation", "diverged", "outside_model", "undetermined", "cancelled", "not_started"]
"""Status of a run of a machine."""


StepSize: TypeAlias = Literal["tenth_of_supply_force", "tenth_of_supply_force_reversed", "scenario", "largest_unsaturated", "required"]
"""Size of the steps of a run: a tenth of the force of the supply and its reverse, a step of a scenario, the largest that meets no limit, or the one of a requirement."""


Leg: TypeAlias = Literal["there", "back", "there_again"]
"""Step of a run, from the force of the operating point and back."""


class TrialStepAnswer(Record):
    """Properties of a step response.

    Attributes
    ----------
    overshoot_percent
        Overshoot, of the step.
    overshoot_percent_reason
        Reason for which the value is absent.
    settling_time_s
        Settling time.
    settling_time_s_reason
        Reason for which the value is absent.
    """

    overshoot_percent: float | None
    overshoot_percent_reason: str | None
    settling_time_s: float | None
    settling_time_s_reason: str | None


class TrialLegAnswer(Record):
    """Step of a machine.

    Attributes
    ----------
    step
        Step of the run.
    overshoot_percent
        Overshoot, of the step.
    overshoot_percent_reason
        Reason for which the value is absent.
    settling_time_s
        Settling time.
    settling_time_s_reason
        Reason for which the value is absent.
    """

    step: Leg
    overshoot_percent: float | None
    overshoot_percent_reason: str | None
    settling_time_s: float | None
    settling_time_s_reason: str | None


class HeldRequirementAnswer(Record):
    """Worst of the steps of a run against a requirement in time.

    Attributes
    ----------
    specification
        Number of the specification, from 1 in the order of the file.
    verdict
        Outcome for the requirement.
    required
        Required step response.
    reached
        Worst step of the run.
    """

    specification: int
    verdict: Satisfaction
    required: RequiredStepAnswer
    reached: WorstStepAnswer


class WorstStepAnswer(Record):
    """Worst of the steps against a requirement in time.

    Attributes
    ----------
    overshoot_percent
        Overshoot, of the step.
    settling_time_s
        Settling time; `inf` if the step does not settle.
    rise_time_s
        Rise from 10 to 90 percent; `inf` if the step does not rise so far.
    """

    overshoot_percent: float
    settling_time_s: float
    rise_time_s: float


class ShapeAnswer(Answer):
    """Answer of `shape`.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    shaped
        Law that is shaped.
    changes
        Number of changes that were made.
    elements
        Elements of the law after the changes, including disabled ones.
    stable
        True if every plant of the family is stable in the loop.
    stable_reason
        Reason for which the value is absent.
    stability
        Stability of the family in the loop.
    margins
        Margin of every specification at each of its design frequencies, the worst first.
    loop
        Nominal loop at the design frequencies.
    unreached_rad_per_s
        Design frequencies that the measurement of a plant does not contain.
    warnings
        Declared effects that the margins do not include.
    """

    schema: int
    version: str
    command: Literal["shape"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    shaped: Shaped
    changes: int
    elements: tuple[ShapedElementAnswer, ...]
    stable: bool | None
    stable_reason: str | None
    stability: ShapedStabilityAnswer
    margins: tuple[ShapedMarginAnswer, ...]
    loop: tuple[LoopPointAnswer, ...]
    unreached_rad_per_s: tuple[float, ...]
    warnings: tuple[str, ...]


Shaped: TypeAlias = Literal["controller", "prefilter"]
"""Law that is shaped, by its table in the project file."""


class ShapedElementAnswer(Record):
    """Element of a controller or prefilter.

    Attributes
    ----------
    number
        Number of the element, from 1.
    kind
        Kind of the element, as in the project file.
    enabled
        True if the element is part of the law.
    element
        Element as the project file states it.
    """

    number: int
    kind: ElementKind
    enabled: bool
    element: str


ElementKind: TypeAlias = Literal["gain", "integrator", "differentiator", "zero", "pole", "complex_zeros", "complex_poles", "lead", "lag", "notch", "roll_off", "pi", "pid", "general"]
"""Kind of an element of a controller or prefilter, as in the project file."""


class ShapedStabilityAnswer(Record):
    """Stability of a family in the shaped loop.

    Attributes
    ----------
    verdict
        Verdict on stability.
    plant
        Plant with the pole of the largest real part, or that is unstable, or that could not be
        resolved.
    reason
        Reason for the verdict.
    """

    verdict: Verdict
    plant: Plant
    reason: str


class ShapedMarginAnswer(Record):
    """Margin of a specification at a design frequency.

    Attributes
    ----------
    specification
        Number of the specification, from 1 in the order of the file.
    kind
        Kind of the specification.
    frequency_rad_per_s
        Frequency; zero or `inf` for a limit towards it.
    margin_db
        Margin; negative if the specification is violated.
    plant
        Plant with the margin; of a spread the one with the greatest |T|.
    other_plant
        Plant with the least |T|, of a spread.
    allowed
        True if the bounds allow the nominal loop.
    slack_db
        Distance to the nearest gain that the bounds forbid at this phase, `inf` if there is
        none; only of an allowed loop.
    gain_change_db
        Change to the nearest gain that the bounds allow at this phase, positive for more gain;
        zero if the loop is allowed.
    gain_change_db_reason
        Reason for which the value is absent.
    """

    specification: int
    kind: SpecificationKind
    frequency_rad_per_s: float
    margin_db: float
    plant: Plant
    other_plant: Plant | None
    allowed: bool | None
    slack_db: float | None
    gain_change_db: float | None
    gain_change_db_reason: str | None


class LoopPointAnswer(Record):
    """Nominal loop at a design frequency.

    Attributes
    ----------
    frequency_rad_per_s
        Design frequency.
    magnitude_db
        Magnitude of the nominal loop.
    phase_deg
        Phase of the nominal loop, greater than -360 and at most 0.
    allowed
        True if the bounds allow the nominal loop.
    slack_db
        Distance to the nearest gain that the bounds forbid at this phase, `inf` if there is
        none; only of an allowed loop.
    gain_change_db
        Change to the nearest gain that the bounds allow at this phase, positive for more gain;
        zero if the loop is allowed.
    gain_change_db_reason
        Reason for which the value is absent.
    """

    frequency_rad_per_s: float
    magnitude_db: float
    phase_deg: float
    allowed: bool | None
    slack_db: float | None
    gain_change_db: float | None
    gain_change_db_reason: str | None


class DesignCommandAnswer(Answer):
    """Answer of `design`.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    status
        Outcome of the design.
    unusable
        Reason not to use the designed controller, only if there is one.
    unfinished
        Parts that were not finished because the design was stopped.
    objective
        Objective of the search.
    seed
        Seed of the pseudo-random numbers of the search.
    controller
        Designed controller G; of a sampled loop in z.
    prefilter
        Prefilter F of the designed loop; of a sampled loop in z.
    prefilter_reason
        Reason for which the value is absent.
    pressure_feedback
        Pressure feedback that was designed before the loop, only if `design.pressure_feedback`
        is free.
    continuous_law
        Controller and prefilter before they are sampled, only of a sampled loop whose
        controller is a continuous law.
    figures_
        Figures by which controllers are compared.
    structure
        Structure of the designed controller.
    manual
        Designed controller in the terms of a controller's manual, before it is sampled.
    manual_reason
        Reason for which the value is absent.
    structures
        Structures that were designed, in the order of the search.
    led_by
        Requirements that led the last search.
    earned_per_pole_db
        Reduction of the compared quantity that each further pole must bring, `inf` if no longer
        structure replaces a shorter one; only if several named structures are designed.
    verification
        Audit of the designed controller over the family and the frequency band.
    published
        Controller that the project gives, with its audit; null if there is none, for the reason
        in `published_reason`.
    continuous_as_sampled
        Controller that was designed without sampling, sampled and audited like the loop, only
        of a sampled loop.
    minimum_delay_margin_s
        Least additional delay that every plant must tolerate.
    limits
        Limits in addition to the specifications.
    reserve_db
        Margin of the search to every limit, for what lies between its plants and frequencies.
    published_reason
        Reason for the absence of `published`.
    rounds
        Rounds of search and audit.
    starts
        Starts of the last search.
    starts_reason
        Reason for which the value is absent.
    binding
        Limits over frequency that bind.
    relaxations
        Gain from relaxing each limit that binds.
    relaxation_db
        Amount by which every limit must be relaxed for a controller to satisfy it.
    relaxation_db_reason
        Reason for which the value is absent.
    conflicts
        Limits that conflict at this relaxation; empty unless the specifications are infeasible.
    explanations
        Facts that are impossible or hard for any controller.
    rounding
        Effect of the converters of the controller's computer, only if a converter rounds.
    machine
        Designed controller on the nonlinear machine.
    machine_reason
        Reason for which the value is absent.
    repair
        Repair of the design, only if the machine contradicts it and a repair was requested.
    repair_reason
        Reason for which the value is absent.
    """

    schema: int
    version: str
    command: Literal["design"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    status: DesignOutcomeKind
    unusable: str | None
    unfinished: tuple[DesignPart, ...]
    objective: ObjectiveAnswer
    seed: int
    controller: FactoredLawAnswer
    prefilter: FactoredLawAnswer | None
    prefilter_reason: str | None
    pressure_feedback: PressureFeedbackAnswer | None
    continuous_law: ContinuousLawAnswer | None
    figures_: LoopFiguresAnswer
    structure: StructureAnswer
    manual: ManualAnswer | None
    manual_reason: str | None
    structures: tuple[ReachedStructureAnswer, ...]
    led_by: LedBy
    earned_per_pole_db: float | None
    verification: AuditAnswer
    published: AuditedControllerAnswer | None
    continuous_as_sampled: AuditedControllerAnswer | None
    minimum_delay_margin_s: float
    limits: tuple[DesignLimitAnswer, ...]
    reserve_db: float
    published_reason: str | None
    rounds: tuple[DesignRoundAnswer, ...]
    starts: SearchStartsAnswer | None
    starts_reason: str | None
    binding: tuple[BindingLimitAnswer, ...]
    relaxations: tuple[RelaxationAnswer, ...]
    relaxation_db: float | None
    relaxation_db_reason: str | None
    conflicts: tuple[BindingLimitAnswer, ...]
    explanations: tuple[ExplanationAnswer, ...]
    rounding: RoundingAnswer | None
    machine: TrialAnswer | None
    machine_reason: str | None
    repair: RepairAnswer | None
    repair_reason: str | None


DesignOutcomeKind: TypeAlias = Literal["met", "not_proven", "missed_in_time", "prefilter_amplifies", "command_beyond_valve", "delay_not_tolerated", "infeasible", "not_converged", "not_stabilised", "stopped"]
"""Outcome of a design: every specification satisfied; satisfied over a family that lacks a declared effect; satisfied, but steps in time, gain of the prefilter, command of steps or tolerated delay missed; violated by every evaluated controller; no agreement of search and audit; no evaluated controller that makes every plant stable; or stopped."""


DesignPart: TypeAlias = Literal["search", "command_of_steps", "machine", "repair", "proof", "relaxations", "without_samples", "published", "templates_and_bounds"]
"""Part of a design that a stop may leave unfinished."""


class ObjectiveAnswer(Record):
    """Objective of a search, with the value of the result.

    Attributes
    ----------
    kind
        Objective of the search.
    value_db
        Objective of the designed controller.
    value_db_reason
        Reason for which the value is absent.
    """

    kind: Objective
    value_db: float | None
    value_db_reason: str | None


Objective: TypeAlias = Literal["least_high_frequency_gain", "least_bandwidth", "best_worst_margin"]
"""Objective of a search, as `design.objective` names it."""


class FactoredLawAnswer(Record):
    """Transfer function k Π(s - z)/Π(s - p), or the same in z.

    Attributes
    ----------
    gain
        Leading coefficient k.
    zeros
        Zeros, each by its real and imaginary part.
    poles
        Poles, each by its real and imaginary part.
    domain
        Variable of the transfer function.
    sample_time_s
        Sample time of a transfer function in z.
    sample_time_s_reason
        Reason for which the value is absent.
    """

    gain: float
    zeros: tuple[complex, ...]
    poles: tuple[complex, ...]
    domain: TimeDomain
    sample_time_s: float | None
    sample_time_s_reason: str | None


TimeDomain: TypeAlias = Literal["s", "z"]
"""Variable of a transfer function: `s` of a continuous one, `z` of a sampled one."""


class PressureFeedbackAnswer(Record):
    """Pressure feedback that was designed before the loop, with the gain from it.

    Attributes
    ----------
    used
        True if the design has the feedback; false if it gains too little for a second measured
        signal.
    gain_v_per_pa
        Gain from the pressure to the command.
    high_pass_rad_per_s
        Corner frequency of the high pass; null if it has none.
    low_pass_rad_per_s
        Corner frequency of the low pass, only if one is declared.
    loop_gain_factor
        Ratio of the largest gain of a proportional loop with the feedback to the one without.
    proportional_gain_v_per_n
        Largest gain of a proportional loop with the feedback.
    proportional_gain_v_per_n_m
        Largest gain of a proportional loop with the feedback.
    proportional_gain_without_v_per_n
        Largest gain of a proportional loop without the feedback.
    proportional_gain_without_v_per_n_m
        Largest gain of a proportional loop without the feedback.
    limited_at_rad_per_s
        Frequency that limits a proportional loop with the feedback.
    limited_without_at_rad_per_s
        Frequency that limits a proportional loop without the feedback.
    least_damping_ratio
        Least damping ratio, with the feedback, of the oscillations of the plants within a
        factor of two of `limited_without_at_rad_per_s`; left out if there are none.
    least_damping_ratio_without
        Least damping ratio of these oscillations without the feedback; left out if there are
        none.
    plants
        Number of plants for which the feedback was designed.
    missing_with_waves
        Plants with waves in their lines for which the feedback was not designed, only if there
        are any.
    """

    used: bool
    gain_v_per_pa: float
    high_pass_rad_per_s: float | None
    low_pass_rad_per_s: float | None
    loop_gain_factor: float
    proportional_gain_v_per_n: float | None
    proportional_gain_v_per_n_m: float | None
    proportional_gain_without_v_per_n: float | None
    proportional_gain_without_v_per_n_m: float | None
    limited_at_rad_per_s: float
    limited_without_at_rad_per_s: float
    least_damping_ratio: float | None
    least_damping_ratio_without: float | None
    plants: int
    missing_with_waves: MissingPlantsAnswer | None


class MissingPlantsAnswer(Record):
    """Plants whose responses cannot be computed.

    Attributes
    ----------
    count
        Number of these plants.
    of
        Number of all plants with waves in their lines.
    reason
        Reason for which the first of them has no response.
    """

    count: int
    of: int
    reason: str


class ContinuousLawAnswer(Record):
    """Continuous laws that are sampled for the loop.

    Attributes
    ----------
    controller
        Controller G(s) before it is sampled.
    prefilter
        Prefilter F(s) before it is sampled.
    """

    controller: FactoredLawAnswer
    prefilter: FactoredLawAnswer


class LoopFiguresAnswer(Record):
    """Figures by which controllers are compared, in addition to their verdicts.

    Attributes
    ----------
    order
        Number of poles of the controller, of the continuous law if it is sampled.
    relative_degree
        Number of poles of the same controller in excess of its zeros.
    prefilter_order
        Number of poles of the prefilter, of the continuous one if it is sampled.
    high_frequency_gain_db
        Limit of s^r G(s) for the relative degree r; for a law in z |G| at half the sample rate.
    high_frequency_gain_of
        Law to which `high_frequency_gain_db` belongs.
    modulus_margin
        Least |1 + L| of the family; null unless every plant is known to be stable.
    gain_margin_db
        Factor by which the gain of the nominal loop may grow; null unless it is known to be
        stable.
    gain_reduction_db
        Factor to which the gain of the nominal loop may fall, negative; `-inf` if it may
        vanish, null unless the loop is known to be stable.
    phase_margin_deg
        Phase margin of the nominal loop; null unless it is known to be stable.
    crossover_rad_per_s
        Highest frequency at which |L| is 1, zero if |L| is never 1; null unless the loop is
        known to be stable.
    first_crossover_rad_per_s
        First frequency at which |L| falls through 1.
    first_crossover_rad_per_s_reason
        Reason for which the value is absent.
    above_again_rad_per_s
        Lowest and highest frequency above the first crossover at which |L| is 1 again, the
        highest `inf` if |L| remains above 1; left out if |L| remains below 1.
    reason
        Reason for which margins are absent.
    """

    order: int
    relative_degree: int
    prefilter_order: int
    high_frequency_gain_db: float
    high_frequency_gain_of: HighFrequencyLaw
    modulus_margin: float | None
    gain_margin_db: float | None
    gain_reduction_db: float | None
    phase_margin_deg: float | None
    crossover_rad_per_s: float | None
    first_crossover_rad_per_s: float | None
    first_crossover_rad_per_s_reason: str | None
    above_again_rad_per_s: Interval | None
    reason: str | None


HighFrequencyLaw: TypeAlias = Literal["law_in_z", "continuous_law"]
"""Form of a law whose gain at high frequency is given."""


class StructureAnswer(Record):
    """Structure of a controller, whose numbers a search chooses from their ranges.

    Attributes
    ----------
    sign
        Sign of the gain, 1 or -1.
    gain
        Least and greatest magnitude of the gain.
    parts
        Factors in series.
    name
        Name of the structure of the designed controller, only if it has one.
    """

    sign: float
    gain: Interval
    parts: tuple[StructurePartAnswer, ...]
    name: NamedStructure | None


class StructurePartAnswer(Record):
    """Factor of a structure, each number by its least and greatest value.

    Attributes
    ----------
    kind
        Kind of the factor.
    frequency_rad_per_s
        Corner frequency, of a pair or notch the natural one; left out if the factor has none.
    damping_ratio
        Damping ratio of a pair, or of the poles of a notch.
    depth
        Magnitude of a notch at its frequency.
    """

    kind: StructureFactor
    frequency_rad_per_s: Interval | None
    damping_ratio: Interval | None
    depth: Interval | None


StructureFactor: TypeAlias = Literal["integrator", "fixed", "zero", "pole", "zero_pair", "pole_pair", "notch"]
"""Factor of a structure."""


NamedStructure: TypeAlias = Literal["p", "i", "pi", "pi_low_pass", "pid", "pi_notch", "pi_notch_low_pass", "pi_notch_lead", "pi_two_notches"]
"""Structure of a controller, as `design.structure` names it."""


class ManualAnswer(Record):
    """Controller in the terms of a controller's manual.

    Attributes
    ----------
    form
        Formulas of the parts.
    parts
        Parts in series, the one with the gain first.
    """

    form: str
    parts: tuple[ManualPartAnswer, ...]


class ManualPartAnswer(Record):
    """Part of a controller with its settings.

    Attributes
    ----------
    kind
        Kind of the part.
    proportional_gain
        Gain K_p, command per controlled quantity.
    integral_gain
        Gain K_i of K_i/s, command per controlled quantity and second.
    integral_time_s
        Integral time T_i.
    derivative_time_s
        Derivative time T_d.
    filter_time_s
        Time constant T_f of the low pass, or of the filter of the derivative.
    frequency_rad_per_s
        Natural frequency, of a notch that of its zeros.
    damping_ratio
        Damping ratio.
    zero_rad_per_s
        Corner frequency of the zero.
    pole_rad_per_s
        Corner frequency of the pole.
    frequency_hz
        Natural frequency of the zeros of a notch.
    depth_db
        Ratio of the damping ratio of the zeros to that of the poles, the magnitude at the
        frequency of the notch; negative.
    width_hz
        Natural frequency of the poles times twice their damping ratio.
    pole_frequency_rad_per_s
        Natural frequency of the poles.
    zero_damping_ratio
        Damping ratio of the zeros.
    pole_damping_ratio
        Damping ratio of the poles.
    """

    kind: ManualPart
    proportional_gain: float | None
    integral_gain: float | None
    integral_time_s: float | None
    derivative_time_s: float | None
    filter_time_s: float | None
    frequency_rad_per_s: float | None
    damping_ratio: float | None
    zero_rad_per_s: float | None
    pole_rad_per_s: float | None
    frequency_hz: float | None
    depth_db: float | None
    width_hz: float | None
    pole_frequency_rad_per_s: float | None
    zero_damping_ratio: float | None
    pole_damping_ratio: float | None


ManualPart: TypeAlias = Literal["p", "i", "pi", "pid", "low_pass", "second_order_low_pass", "lead", "lag", "notch"]
"""Part of a controller, as manuals name it."""


class ReachedStructureAnswer(Record):
    """Structure that was designed, with the result.

    Attributes
    ----------
    name
        Name of the structure, only if it has one.
    words
        Structure in words, as it was found.
    order
        Number of poles.
    status
        Outcome for the structure.
    taken
        True if the design has this structure.
    slowest_zero_rad_per_s
        Lowest frequency at which a zero was searched for, only if a zero is at this frequency.
    worst_margin_db
        Least margin over the plants and frequencies that the search evaluated; left out if no
        controller makes these plants stable.
    binding
        Limit with this margin, only if it leaves the loop no room.
    binding_rad_per_s
        Frequency of this margin.
    crossover_rad_per_s
        Highest frequency at which |L| is 1, zero if |L| is never 1; null unless the loop is
        known to be stable.
    first_crossover_rad_per_s
        First frequency at which |L| falls through 1.
    first_crossover_rad_per_s_reason
        Reason for which the value is absent.
    above_again_rad_per_s
        Lowest and highest frequency above the first crossover at which |L| is 1 again, the
        highest `inf` if |L| remains above 1; left out if |L| remains below 1.
    delay_margin_s
        Least additional dead time that makes the nominal loop unstable; left out unless the
        loop is known to be stable.
    high_frequency_gain_db
        Limit of s^r G(s) for the relative degree r; left out without a controller.
    relative_degree
        Number of poles in excess of zeros.
    compared_db
        Quantity by which structures are compared, the less the better: the largest gain from
        sensor noise to the command of the nominal loop, or the objective.
    worst_overshoot_percent
        Greatest overshoot of the linear steps, of the step: of the structure that is taken over
        the whole family, of others over some of its members; only if one is required.
    worst_settling_time_s
        Longest settling time of the linear steps of the same plants, `inf` if a step does not
        settle; only if one is required.
    worst_rise_time_s
        Longest rise from 10 to 90 percent of the linear steps of the same plants, `inf` if a
        step does not rise; only if one is required.
    """

    name: NamedStructure | None
    words: str
    order: int
    status: StructureOutcome
    taken: bool
    slowest_zero_rad_per_s: float | None
    worst_margin_db: float | None
    binding: str | None
    binding_rad_per_s: float | None
    crossover_rad_per_s: float | None
    first_crossover_rad_per_s: float | None
    first_crossover_rad_per_s_reason: str | None
    above_again_rad_per_s: Interval | None
    delay_margin_s: float | None
    high_frequency_gain_db: float | None
    relative_degree: int
    compared_db: float | None
    worst_overshoot_percent: float | None
    worst_settling_time_s: float | None
    worst_rise_time_s: float | None


StructureOutcome: TypeAlias = Literal["met", "missed_in_time", "missed", "not_earned", "not_converged", "not_stabilised"]
"""Outcome of the search with a structure: limits satisfied, steps missed in time, limits missed, given up since it is not worth its poles, no agreement of search and audit, or no controller that makes every plant stable."""


LedBy: TypeAlias = Literal["frequency", "linear_steps", "nonlinear_runs"]
"""Requirements that led the last search: limits over frequency, the steps of the linear loop, or these steps with what the runs of the nonlinear rig added."""


class AuditAnswer(Record):
    """Audit of a controller and prefilter over the family and the frequency band.

    Attributes
    ----------
    verdict
        Verdict on stability and all specifications.
    evidence
        Weakest evidence behind the verdict.
    tolerance_db
        Violation that still counts as met.
    stable
        True if every plant of the family is stable in the loop.
    stable_reason
        Reason for which the value is absent.
    stability
        Stability of the family.
    proof
        Proof of stability over the box, if a proof was requested.
    delay_margin_s
        Least additional delay that makes a plant of the family unstable.
    delay_margin_s_reason
        Reason for which the value is absent.
    delay_margin
        Place of the delay margin.
    gain_reduction_db
        Factor to which the gain of the nominal loop may fall, negative; `-inf` if it may
        vanish.
    gain_reduction_db_reason
        Reason for which the value is absent.
    margins
        Margins of the nominal loop and the worst of the family.
    members
        Number of plants of the family.
    position
        Position of every plant, only if all plants have it and a rig is declared.
    parameters
        Names of the parameters of a plant, in the order of the tables in files.
    timing
        Sampling and delay of the loop.
    velocity_noise
        Noise of the load velocity that is fed forward, if a sensor measures it.
    pressure_noise
        Noise of the pressures that are fed back, if any.
    amplifying_prefilter
        Gain of the prefilter, only if it amplifies.
    specifications
        Findings in the order of the specifications in the file; those without a number in the
        file, such as a limit on rounding, are last.
    warnings
        Declared effects that the audit does not include.
    below_design
        Limits of a design that the loop exceeds, which are no part of the verdict.
    satisfied_limits_of_design
        Limits of a design that the loop satisfies.
    """

    verdict: Verdict
    evidence: Evidence
    tolerance_db: float
    stable: bool | None
    stable_reason: str | None
    stability: StabilityAnswer
    proof: AuditProofAnswer | None
    delay_margin_s: float | None
    delay_margin_s_reason: str | None
    delay_margin: DelayMarginAnswer | None
    gain_reduction_db: float | None
    gain_reduction_db_reason: str | None
    margins: AuditMarginsAnswer
    members: int
    position: CommonPositionAnswer | None
    parameters: tuple[str, ...]
    timing: TimingAnswer
    velocity_noise: VelocityNoiseAnswer | None
    pressure_noise: PressureNoiseAnswer | None
    amplifying_prefilter: AmplifyingPrefilterAnswer | None
    specifications: tuple[AuditedSpecification, ...]
    warnings: tuple[str, ...]
    below_design: tuple[ExceededLimitAnswer, ...] | None
    satisfied_limits_of_design: tuple[DesignLimitKind, ...] | None


class AuditedControllerAnswer(Record):
    """Controller and prefilter with their audit.

    Attributes
    ----------
    controller
        Controller G.
    prefilter
        Prefilter F; 1 if the loop has none.
    figures
        Figures by which controllers are compared.
    verification
        Audit over the family and the frequency band.
    """

    controller: FactoredLawAnswer
    prefilter: FactoredLawAnswer
    figures: LoopFiguresAnswer
    verification: AuditAnswer


class DesignLimitAnswer(Record):
    """Limit of a design in addition to its specifications.

    Attributes
    ----------
    key
        Limit in `[design]`.
    value
        Value of a ratio or gain.
    value_rad_per_s
        Value of a bandwidth or natural frequency.
    value_s
        Value of a delay.
    origin
        Origin of the value.
    satisfied
        True if the design satisfies the limit.
    worst_margin_db
        Least margin of the family; negative if the limit is exceeded, left out if it is
        unknown.
    binds
        True if the limit leaves the search no room; left out if this is unknown.
    command
        Largest command of the steps of the scenarios, only of the limit on it.
    relaxed
        Gain from relaxing the limit, only if it binds.
    """

    key: DesignLimitKind
    value: float | None
    value_rad_per_s: float | None
    value_s: float | None
    origin: LimitOrigin
    satisfied: bool
    worst_margin_db: float | None
    binds: bool | None
    command: CommandOfStepsAnswer | None
    relaxed: RelaxedValueAnswer | None


class CommandOfStepsAnswer(Record):
    """Largest command that the steps of the scenarios take, as a search over the linear steps of the family finds it.

    Attributes
    ----------
    scenario
        Scenario whose command takes most of the limit.
    from_n
        Reference before the step after which the command is largest.
    from_n_m
        Reference before the step after which the command is largest.
    to_n
        Reference after this step.
    to_n_m
        Reference after this step.
    at_s
        Time of the largest command in the scenario.
    peak
        Phase of the response in which the command is largest.
    largest_v
        Largest magnitude of the command.
    at_rest_v
        Largest command that remains between steps under any controller.
    limit_v
        Limit of the command.
    largest_step_n
        Largest single step of this sign, from rest at the reference before the step, within the
        limits of command, supply and sensor.
    largest_step_n_m
        Largest single step of this sign, from rest at the reference before the step, within the
        limits of command, supply and sensor.
    step_limit
        Limit of the largest single step.
    evidence
        Evidence for the largest command.
    plants
        Number of plants that the search evaluated.
    plant
        Plant with the largest command.
    moved_by
        Names of the parameters that change the largest command.
    """

    scenario: str
    from_n: float | None
    from_n_m: float | None
    to_n: float | None
    to_n_m: float | None
    at_s: float
    peak: CommandPeakKind
    largest_v: float
    at_rest_v: float
    limit_v: float
    largest_step_n: float | None
    largest_step_n_m: float | None
    step_limit: StepLimit
    evidence: Evidence
    plants: int
    plant: Plant
    moved_by: tuple[str, ...]


CommandPeakKind: TypeAlias = Literal["at_rest", "transient"]
"""Phase of a response to a step: at rest after it, or in the transient on the way there."""


StepLimit: TypeAlias = Literal["command", "supply", "sensor"]
"""Limit of the largest step: the command of the valve, the force at which the supply stalls the actuator, or the capacity of the force sensor."""


class RelaxedValueAnswer(Record):
    """Limit of `[design]` with the relaxed value, and the gain from it.

    Attributes
    ----------
    value
        Value of a ratio or gain.
    value_rad_per_s
        Value of a bandwidth or natural frequency.
    value_s
        Value of a delay.
    objective_gained_db
        Reduction of the objective, of a design that satisfies its limits.
    worst_margin_gained_db
        Increase of the worst margin, of a design for the best one or one that violates a limit.
    noise_gained_db
        Reduction of the largest gain from sensor noise to the command of the nominal loop;
        negative if it rises, left out if it is unknown.
    """

    value: float | None
    value_rad_per_s: float | None
    value_s: float | None
    objective_gained_db: float | None
    worst_margin_gained_db: float | None
    noise_gained_db: float | None


class DesignRoundAnswer(Record):
    """Search with the audit that followed it.

    Attributes
    ----------
    structure
        Structure whose numbers were searched for.
    objective_db
        Objective of the result.
    plants
        Number of plants that the search evaluated.
    frequencies
        Number of frequencies that the search evaluated.
    searched_margin_db
        Worst margin on these plants and frequencies.
    audited_margin_db
        Worst margin of the audit; null if the audit finds an unstable plant.
    reason
        Reason for which the audit has no margin.
    """

    structure: StructureAnswer
    objective_db: float
    plants: int
    frequencies: int
    searched_margin_db: float
    audited_margin_db: float | None
    reason: str | None


class SearchStartsAnswer(Record):
    """Starts of the last search, which show how much the result depends on them; of three numbers the best, the median and the worst.

    Attributes
    ----------
    evaluated
        Number of points that the search evaluated before its descents.
    stabilised
        Number of these points that make every evaluated plant stable.
    completed
        Number of completed descents.
    worst_margin_db
        Worst margin at the ends of the descents; null if no descent was completed.
    objective_db
        Objective at the ends that satisfy every limit; null if none does.
    """

    evaluated: int
    stabilised: int
    completed: int
    worst_margin_db: tuple[float, float, float] | None
    objective_db: tuple[float, float, float] | None


class BindingLimitAnswer(Record):
    """Limit over frequency that binds or conflicts, at the frequency where it does.

    Attributes
    ----------
    specification
        Number of the limit of the search, from 1: the specifications over frequency in the
        order of the file, then the limits of `[design]`.
    name
        Name of the limit.
    kind
        Kind of the specification.
    kind_reason
        Reason for which the value is absent.
    frequency_rad_per_s
        Frequency of the margin; zero or `inf` for a limit towards it.
    margin_db
        Margin; negative if the limit is exceeded.
    plant
        Plant with the margin.
    """

    specification: int
    name: str
    kind: SpecificationKind | None
    kind_reason: str | None
    frequency_rad_per_s: float
    margin_db: float
    plant: Plant


class RelaxationAnswer(Record):
    """Gain from relaxing one limit, as the last search finds it from its result, without an audit.

    Attributes
    ----------
    specification
        Index of the specification over frequency, from 0 in the order of the file.
    number
        Number of the specification of a required step, from 1 in the order of the file.
    key
        Limit in `[design]`.
    name
        Name of the limit.
    relaxed_by
        Fraction by which the limit is wider.
    objective_gained_db
        Reduction of the objective, of a design that satisfies its limits.
    worst_margin_gained_db
        Increase of the worst margin, of a design for the best one or one that violates a limit.
    noise_gained_db
        Reduction of the largest gain from sensor noise to the command of the nominal loop;
        negative if it rises, left out if it is unknown.
    """

    specification: int | None
    number: int | None
    key: DesignLimitKind | None
    name: str
    relaxed_by: float
    objective_gained_db: float | None
    worst_margin_gained_db: float | None
    noise_gained_db: float | None


class ExplanationAnswer(Record):
    """Fact that is impossible or hard for any controller.

    Attributes
    ----------
    sentence
        Fact in a sentence.
    severity
        Consequence of the fact.
    frequency_rad_per_s
        Frequency of the fact, only if it has one.
    plants
        Plants that it concerns.
    specifications
        Indices of the limits that it concerns, from 0: the specifications over frequency in the
        order of the file, then the limits of `[design]`.
    relaxation_db
        Least common relaxation of all limits that may help.
    """

    sentence: str
    severity: ExplanationSeverity
    frequency_rad_per_s: float | None
    plants: tuple[Plant, ...]
    specifications: tuple[int, ...]
    relaxation_db: float | None


ExplanationSeverity: TypeAlias = Literal["impossible", "warning"]
"""Consequence of a fact: no controller satisfies the specifications, or one is hard to find."""


class RoundingAnswer(Record):
    """Effect of the converters of the controller's computer on the loop.

    Attributes
    ----------
    effects
        Effect of each rounded signal on others; left out if there is none.
    command_steps_at_once
        Immediate change of the command for one step of the measurement, in steps of the
        command.
    limit_cycle
        Ability of the loop to come to rest; left out if it is unknown.
    reason
        Reason for which the effect is unknown.
    """

    effects: tuple[RoundingEffectAnswer, ...] | None
    command_steps_at_once: float | None
    limit_cycle: LimitCycle | None
    reason: str | None


class RoundingEffectAnswer(Record):
    """Largest effect of a rounded signal over the plants, in the SI unit of the affected signal.

    Attributes
    ----------
    of
        Rounded signal.
    on
        Affected signal.
    peak
        Largest possible effect at any sample.
    peak_plant
        Plant with this peak.
    rms
        Root-mean-square effect of independent rounding errors.
    rms_plant
        Plant with this root-mean-square effect.
    """

    of: RoundedSignal
    on: RoundedSignal
    peak: float
    peak_plant: Plant
    rms: float
    rms_plant: Plant


RoundedSignal: TypeAlias = Literal["command", "measurement", "output"]
"""Signal that a converter rounds, or that rounding affects."""


LimitCycle: TypeAlias = Literal["not_integrating", "can_rest", "expected"]
"""Ability of a loop to come to rest between the levels of its converters: it does not integrate, it can rest, or a limit cycle between two levels is expected."""


class RepairAnswer(Record):
    """Repair of a design that the nonlinear machine contradicts: the plant of that machine is added to the family, and the search continues.

    Attributes
    ----------
    status
        Outcome of the repair.
    added_plant
        Name of the run of the machine whose plant was added.
    added_plant_reason
        Reason for which the value is absent.
    quarter_wave_rad_per_s
        Frequency at which the slower line of this machine is a quarter of a wave long.
    quarter_wave_rad_per_s_reason
        Reason for which the value is absent.
    relaxation_db
        Amount by which every limit must be relaxed for a controller to satisfy it.
    relaxation_db_reason
        Reason for which the value is absent.
    conflicts
        Limits that conflict at this relaxation.
    plant_before
        Audit of the first design with the added plant, only if such a plant is known.
    plant_after
        Audit of the controller that was found with the added plant, only if one was found.
    before
        First design, only if the repair replaced it.
    nearest
        Controller that comes nearest, only if none satisfies every specification.
    nearest_machine
        Trial of the nearest controller on the nonlinear machine.
    nearest_rounds
        Rounds of the search for the nearest controller, those of the first design first.
    family_with_waves
        Audit of the controller that was found with waves in every plant of the family, only if
        it is known.
    sentences
        Steps of the repair, and the limits of what it can achieve, in sentences.
    """

    status: RepairStatus
    added_plant: str | None
    added_plant_reason: str | None
    quarter_wave_rad_per_s: float | None
    quarter_wave_rad_per_s_reason: str | None
    relaxation_db: float | None
    relaxation_db_reason: str | None
    conflicts: tuple[BindingLimitAnswer, ...]
    plant_before: AuditAnswer | None
    plant_after: AuditAnswer | None
    before: AuditedControllerAnswer | None
    nearest: AuditedControllerAnswer | None
    nearest_machine: TrialAnswer | None
    nearest_rounds: tuple[DesignRoundAnswer, ...] | None
    family_with_waves: AuditAnswer | None
    sentences: tuple[str, ...]


RepairStatus: TypeAlias = Literal["met", "infeasible", "not_converged", "not_stabilised", "stopped", "nothing_to_add"]
"""Outcome of a repair."""


class SimulateAnswer(Answer):
    """Answer of `simulate`.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    frequency_response
        Frequency response of the machine, only if it was requested: then no scenario is run.
    scenarios
        Runs in the order of the scenarios in the file.
    not_run
        Names of the scenarios that were not started.
    warnings
        Misfits of identified parts, which the runs do not contain, if any.
    """

    schema: int
    version: str
    command: Literal["simulate"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    frequency_response: MachineResponsesAnswer | None
    scenarios: tuple[ScenarioAnswer, ...]
    not_run: tuple[str, ...]
    warnings: tuple[str, ...] | None


class MachineResponsesAnswer(Record):
    """Responses of a machine to sines at its equilibrium, compared with the linear plant.

    Attributes
    ----------
    position_m
        Position of the piston at equilibrium, from the A end.
    angle_rad
        Position of the piston at equilibrium, from the A end.
    force_n
        Force on the load at equilibrium.
    torque_n_m
        Force on the load at equilibrium.
    command_v
        Command at equilibrium.
    stopped
        True if the command was stopped before all frequencies were simulated.
    open_loop
        Response from command to force, in N/V, of a motor in N m/V.
    closed_loop
        Response from reference to force, which is a ratio.
    closed_loop_reason
        Reason for which the value is absent.
    """

    position_m: float | None
    angle_rad: float | None
    force_n: float | None
    torque_n_m: float | None
    command_v: float
    stopped: bool
    open_loop: MachineResponseAnswer
    closed_loop: MachineResponseAnswer | None
    closed_loop_reason: str | None


class MachineResponseAnswer(Record):
    """Response of a machine at its frequencies.

    Attributes
    ----------
    points
        Points by rising frequency.
    """

    points: tuple[MachineResponsePointAnswer, ...]


class MachineResponsePointAnswer(Record):
    """Response of a machine at one frequency, with those of two models.

    Attributes
    ----------
    frequency_rad_per_s
        Frequency of the sine.
    amplitude_v
        Amplitude of the sine of the command, in the open loop.
    amplitude_n
        Amplitude of the sine of the reference, in the closed loop.
    amplitude_n_m
        Amplitude of the sine of the reference, in the closed loop.
    machine
        Fundamental of the force over the amplitude.
    machine_reason
        Reason for which the value is absent.
    machine_magnitude_db
        Magnitude of the machine over that of 1 in the unit of the response; null with a
        `reason`.
    machine_phase_deg
        Phase of the machine without jumps by a full turn from one frequency to the next; null
        with a `reason`.
    linear_plant
        Response of the linear plant, or of the loop around it.
    linearised_machine
        Response of the exact derivatives of the machine at its equilibrium; null if they form
        no linear system of finite order.
    linearised_machine_reason
        Reason for which there is no linearised machine; null if there is one.
    difference_db
        Magnitude of the machine over that of the linear plant; null with a `reason`.
    difference_deg
        Phase of the machine less that of the linear plant, within half a turn; null with a
        `reason`.
    linearised_difference_db
        Magnitude of the machine over that of the linearised machine; null with a `reason`.
    linearised_difference_deg
        Phase of the machine less that of the linearised machine, within half a turn; null with
        a `reason`.
    distortion_percent
        Root of the sum of squares of the harmonics from the second to the twentieth, of the
        fundamental; null with a `reason`.
    reason
        Reason for which a difference or the distortion is absent; null if none is.
    settled
        True if the fundamental changed by a ten-thousandth or less between the last two
        windows.
    change_percent
        Change of the fundamental between the last two windows.
    change_percent_reason
        Reason for which the value is absent.
    periods
        Number of simulated periods.
    steps
        Number of steps of the integration.
    reached
        Conditions that the machine meets, which are outside the neighbourhood of the
        equilibrium.
    early_end
        Status of a simulation that ended before the response settled.
    early_end_reason
        Reason for which the value is absent.
    """

    frequency_rad_per_s: float
    amplitude_v: float | None
    amplitude_n: float | None
    amplitude_n_m: float | None
    machine: complex | None
    machine_reason: str | None
    machine_magnitude_db: float | None
    machine_phase_deg: float | None
    linear_plant: complex
    linearised_machine: complex | None
    linearised_machine_reason: str | None
    difference_db: float | None
    difference_deg: float | None
    linearised_difference_db: float | None
    linearised_difference_deg: float | None
    distortion_percent: float | None
    reason: str | None
    settled: bool
    change_percent: float | None
    change_percent_reason: str | None
    periods: int
    steps: int
    reached: tuple[OccurrenceKind, ...]
    early_end: RunStatus | None
    early_end_reason: str | None


OccurrenceKind: TypeAlias = Literal["cavitation_a", "cavitation_b", "end_stop_a", "end_stop_b", "empty_a", "empty_b", "load_contact", "supply_lost", "accumulator_empty_a", "accumulator_empty_b", "accumulator_overpressure_a", "accumulator_overpressure_b", "series_end", "cavitation_transmission", "relief_valve_a", "relief_valve_b", "check_valve_a", "check_valve_b", "command_limit", "cavitation_line_a", "cavitation_line_b", "working_pressure_a", "working_pressure_b", "burst_pressure_a", "burst_pressure_b", "turbulent_line_a", "turbulent_line_b", "turbulent_neck_a", "turbulent_neck_b", "turbulent_transmission"]
"""Condition of a machine or of its command, of which those of a line only begin."""


class ScenarioAnswer(Record):
    """Run of a scenario.

    Attributes
    ----------
    name
        Name of the scenario.
    status
        Status of the run.
    end_time_s
        Simulated time at which the run ended early.
    end_time_s_reason
        Reason for which the value is absent.
    divergence
        Divergence of a run that reached its end.
    divergence_reason
        Reason for which the value is absent.
    unresolved_mode
        Growing mode whose oscillation needs more steps than are permitted.
    unresolved_mode_reason
        Reason for which the value is absent.
    work
        Steps of the reported pass.
    tolerance
        Tolerance of the integration in the reported pass.
    sample_interval_s
        Time between two samples of the signals.
    open_loop
        True if a stated command drives the valve and no controller.
    state_file
        Name of the file with the final state, which is written with `--out`.
    state_file_reason
        Reason for which the value is absent.
    events
        Windows of the run with their metrics, each from an event to the next.
    occurrences
        Beginnings and ends of conditions of the machine and of its command, in the order of
        time.
    outside_model_s
        Time from which the equations of the machine do not hold.
    outside_model_s_reason
        Reason for which the value is absent.
    measured
        Measured signals compared with the simulated ones.
    errors_amplified
        Growth by which errors within the tolerance may become visible.
    errors_amplified_reason
        Reason for which the value is absent.
    kinks_unfollowed
        Kinks from which no deviation was carried to the next, so that their amplification is
        not known.
    kinks_unfollowed_reason
        Reason for which the value is absent.
    repetition
        Passes of a run that was repeated because errors may be visible.
    repetition_reason
        Reason for which the value is absent.
    check
        Difference from a run at a tenth of the tolerance, if requested.
    check_reason
        Reason for which the value is absent.
    beyond_expansion
        Chambers whose pressure exceeded that up to which the expansion of their hose is stated.
    adjustment_brought_j
        Work of the adjustment into the oil: integral of its power while that is positive.
    adjustment_brought_j_reason
        Reason for which the value is absent.
    adjustment_taken_j
        Work of the adjustment out of the oil, as a magnitude: integral of its power while that
        is negative.
    adjustment_taken_j_reason
        Reason for which the value is absent.
    gas_valve_throttled_j
        Energy lost in the valves between chambers and gas.
    gas_valve_throttled_j_reason
        Reason for which the value is absent.
    gas
        Gas at each chamber that has some.
    ledgers
        Accounts of oil and energy over the run, if requested.
    ledgers_reason
        Reason for which the value is absent.
    exceeded
        Limits of the rig that the run exceeds.
    requirements
        Requirements in time against the steps of the run.
    """

    name: str
    status: RunStatus
    end_time_s: float | None
    end_time_s_reason: str | None
    divergence: DivergenceAnswer | None
    divergence_reason: str | None
    unresolved_mode: UnresolvedModeAnswer | None
    unresolved_mode_reason: str | None
    work: StepCountsAnswer
    tolerance: float
    sample_interval_s: float
    open_loop: bool
    state_file: str | None
    state_file_reason: str | None
    events: tuple[ScenarioEventAnswer, ...]
    occurrences: tuple[OccurrenceAnswer, ...]
    outside_model_s: float | None
    outside_model_s_reason: str | None
    measured: tuple[MeasuredSignalAnswer, ...]
    errors_amplified: AmplificationAnswer | None
    errors_amplified_reason: str | None
    kinks_unfollowed: UnfollowedKinksAnswer | None
    kinks_unfollowed_reason: str | None
    repetition: RepetitionAnswer | None
    repetition_reason: str | None
    check: ToleranceCheckAnswer | None
    check_reason: str | None
    beyond_expansion: tuple[BeyondExpansionAnswer, ...]
    adjustment_brought_j: float | None
    adjustment_brought_j_reason: str | None
    adjustment_taken_j: float | None
    adjustment_taken_j_reason: str | None
    gas_valve_throttled_j: float | None
    gas_valve_throttled_j_reason: str | None
    gas: tuple[ChamberGasAnswer, ...]
    ledgers: RunLedgersAnswer | None
    ledgers_reason: str | None
    exceeded: tuple[ExceededRigLimitAnswer, ...]
    requirements: tuple[ScenarioRequirementAnswer, ...]


class DivergenceAnswer(Record):
    """Divergence of a run that reached its end.

    Attributes
    ----------
    kind
        Kind of the divergence.
    since_s
        Time at which it begins, or at which the force is largest.
    range_v
        Range of the command to either side of zero.
    swings
        Number of swings from one end of the range to the other until the end of the run.
    force_n
        Largest magnitude of the force at the end of the run.
    torque_n_m
        Largest magnitude of the force at the end of the run.
    reference_n
        Largest magnitude of the reference.
    reference_n_m
        Largest magnitude of the reference.
    """

    kind: Divergence
    since_s: float
    range_v: float | None
    swings: int | None
    force_n: float | None
    torque_n_m: float | None
    reference_n: float | None
    reference_n_m: float | None


Divergence: TypeAlias = Literal["command_beyond_range", "command_swings", "force_beyond_reference"]
"""Kind of a divergence: a command that remains at the end of its range or beyond, one that swings from end to end, or a force of more than ten times the largest reference."""


class UnresolvedModeAnswer(Record):
    """Mode that grows and is not resolved.

    Attributes
    ----------
    frequency_rad_per_s
        Magnitude of its eigenvalue.
    growth_per_s
        Real part of its eigenvalue, which is positive.
    """

    frequency_rad_per_s: float
    growth_per_s: float


class StepCountsAnswer(Record):
    """Steps of an integration.

    Attributes
    ----------
    steps
        Number of accepted steps.
    rejected
        Number of rejected steps, which were repeated with a shorter step.
    evaluations
        Number of evaluations of the rates, without those for derivatives at the start of each
        step.
    """

    steps: int
    rejected: int
    evaluations: int


class ScenarioEventAnswer(Record):
    """Event of a run, with the metrics of the time from it to the next.

    Attributes
    ----------
    kind
        Kind of the event.
    time_s
        Time of the event, from the start of the scenario.
    until_s
        Time of the next event, or the end of the scenario.
    reference_n
        Reference before and after its step.
    reference_n_m
        Reference before and after its step.
    reference_n_reason
        Reason for which the value is absent.
    reference_n_m_reason
        Reason for which the value is absent.
    command_v
        Open-loop command before and after its step.
    command_v_reason
        Reason for which the value is absent.
    metrics
        Metrics of the event.
    """

    kind: Cause
    time_s: float
    until_s: float
    reference_n: tuple[float, float] | None
    reference_n_m: tuple[float, float] | None
    reference_n_reason: str | None
    reference_n_m_reason: str | None
    command_v: tuple[float, float] | None
    command_v_reason: str | None
    metrics: EventMetricsAnswer


Cause: TypeAlias = Literal["reference_step", "reference_motion", "command_step", "command_motion", "load_motion", "external_force", "setting_change"]
"""Kind of an event: a step of the reference or of the open-loop command, the beginning of a part of either that moves otherwise, or the beginning of a motion of the load, of an external force or of a change of the setting of accumulators."""


class EventMetricsAnswer(Record):
    """Metrics of an event, of the solution itself and not of its samples.

    Attributes
    ----------
    overshoot_percent
        Excess of the force over the new reference, of the step.
    overshoot_percent_reason
        Reason for which the value is absent.
    rise_time_s
        Time from 10 to 90 percent of the step, each where the force first reaches it.
    rise_time_s_reason
        Reason for which the value is absent.
    settling_time_s
        Time from the event until the force remains within the band around the reference, for
        the last tenth of the time to the next event at least.
    settling_time_s_reason
        Reason for which the value is absent.
    settling_band_percent
        Half width of the band of the settling time, of the step, or of the reference if the
        load disturbs it.
    disturbance_peak_n
        Largest magnitude of the difference between force and reference while the load moves or
        an external force acts, and afterwards.
    disturbance_peak_n_m
        Largest magnitude of the difference between force and reference while the load moves or
        an external force acts, and afterwards.
    disturbance_peak_n_reason
        Reason for which the value is absent.
    disturbance_peak_n_m_reason
        Reason for which the value is absent.
    tracking_error_peak_n
        Largest magnitude of the difference between force and reference while the reference
        moves.
    tracking_error_peak_n_m
        Largest magnitude of the difference between force and reference while the reference
        moves.
    tracking_error_peak_n_reason
        Reason for which the value is absent.
    tracking_error_peak_n_m_reason
        Reason for which the value is absent.
    force_peak_n
        Largest magnitude of the force if there is no reference.
    torque_peak_n_m
        Largest magnitude of the force if there is no reference.
    force_peak_n_reason
        Reason for which the value is absent.
    torque_peak_n_m_reason
        Reason for which the value is absent.
    steady_state_error_n
        Reference less force at the end of the event.
    steady_state_error_n_m
        Reference less force at the end of the event.
    steady_state_error_n_reason
        Reason for which the value is absent.
    steady_state_error_n_m_reason
        Reason for which the value is absent.
    control_peak_v
        Largest magnitude of the command.
    control_peak_v_reason
        Reason for which the value is absent.
    control_rms_v
        Root mean square of the command.
    control_rms_v_reason
        Reason for which the value is absent.
    """

    overshoot_percent: float | None
    overshoot_percent_reason: str | None
    rise_time_s: float | None
    rise_time_s_reason: str | None
    settling_time_s: float | None
    settling_time_s_reason: str | None
    settling_band_percent: float
    disturbance_peak_n: float | None
    disturbance_peak_n_m: float | None
    disturbance_peak_n_reason: str | None
    disturbance_peak_n_m_reason: str | None
    tracking_error_peak_n: float | None
    tracking_error_peak_n_m: float | None
    tracking_error_peak_n_reason: str | None
    tracking_error_peak_n_m_reason: str | None
    force_peak_n: float | None
    torque_peak_n_m: float | None
    force_peak_n_reason: str | None
    torque_peak_n_m_reason: str | None
    steady_state_error_n: float | None
    steady_state_error_n_m: float | None
    steady_state_error_n_reason: str | None
    steady_state_error_n_m_reason: str | None
    control_peak_v: float | None
    control_peak_v_reason: str | None
    control_rms_v: float | None
    control_rms_v_reason: str | None


class OccurrenceAnswer(Record):
    """Beginning or end of a condition of the machine.

    Attributes
    ----------
    time_s
        Time from the start of the scenario.
    kind
        Condition of the machine.
    begins
        True if the condition begins, false if it ends.
    """

    time_s: float
    kind: OccurrenceKind
    begins: bool


class MeasuredSignalAnswer(Record):
    """Measured signal compared with the simulated one.

    Attributes
    ----------
    file
        File with the measurement.
    column
        Column of the file.
    signal
        Name of the simulated signal.
    rows
        Number of compared rows.
    rows_outside
        Number of rows before the scenario begins or after the simulated time.
    rmse
        Root mean square of the difference, in the SI unit of the signal.
    rmse_reason
        Reason for which the value is absent.
    nrmse
        Ratio of `rmse` to the range of the measured values.
    nrmse_reason
        Reason for which the value is absent.
    """

    file: str
    column: str
    signal: str
    rows: int
    rows_outside: int
    rmse: float | None
    rmse_reason: str | None
    nrmse: float | None
    nrmse_reason: str | None


class AmplificationAnswer(Record):
    """Growth by which errors within the tolerance may become visible.

    Attributes
    ----------
    from_s
        Simulated time at which the growth begins.
    until_s
        Simulated time at which the growth is largest.
    frequency_rad_per_s
        Magnitude of the eigenvalue of the growing mode at that time.
    frequency_rad_per_s_reason
        Reason for which the value is absent.
    growth_logarithm
        Natural logarithm of the growth factor.
    cause
        Cause of the growth.
    """

    from_s: float
    until_s: float
    frequency_rad_per_s: float | None
    frequency_rad_per_s_reason: str | None
    growth_logarithm: float
    cause: GrowthCause


GrowthCause: TypeAlias = Literal["mode", "closed_loop", "motion"]
"""Cause that amplifies errors: a mode of the machine, the closed loop with its samples or delays, or the motion from kink to kink."""


class UnfollowedKinksAnswer(Record):
    """Kinks, as of friction, stops and contacts, from which no deviation was carried to the next.

    Attributes
    ----------
    steps
        Number of steps that pass a kink.
    cause
        Reason why no deviation was carried.
    """

    steps: int
    cause: UnfollowedCause


UnfollowedCause: TypeAlias = Literal["samples", "delays", "method"]
"""Reason why a deviation is not carried along a run: a sampled controller, a delay of a command or of a wave, or a method of integration without a matrix for it."""


class RepetitionAnswer(Record):
    """Passes of a run that was repeated because errors may be visible.

    Attributes
    ----------
    status
        Agreement of the passes.
    passes
        Passes in order.
    spread
        Largest difference between the last two compared passes.
    spread_reason
        Reason for which the value is absent.
    """

    status: PassAgreement
    passes: tuple[ScenarioPassAnswer, ...]
    spread: PassSpreadAnswer | None
    spread_reason: str | None


PassAgreement: TypeAlias = Literal["agreed", "apart", "undetermined", "stopped"]
"""Agreement of the passes of a repeated run: the last two agree to a thousandth, they do not at the smallest tolerance, roundings at the start change the result, or a pass ended early."""


class ScenarioPassAnswer(Record):
    """Pass of a run that was repeated.

    Attributes
    ----------
    tolerance
        Tolerance of the integration.
    moved_start
        True if each state begins a few roundings away from its start value.
    status
        Status of the pass.
    steps
        Number of accepted steps.
    rejected
        Number of rejected steps, which were repeated with a shorter step.
    evaluations
        Number of evaluations of the rates, without those for derivatives at the start of each
        step.
    """

    tolerance: float
    moved_start: bool
    status: RunStatus
    steps: int
    rejected: int
    evaluations: int


class PassSpreadAnswer(Record):
    """Largest difference between two passes.

    Attributes
    ----------
    event
        Number of the event, from 1.
    event_reason
        Reason for which the value is absent.
    metric
        Name of the metric, or of the force if there is no metric.
    before
        Value of the earlier pass, in the unit of the metric.
    before_reason
        Reason for which the value is absent.
    after
        Value of the later pass, in the unit of the metric.
    after_reason
        Reason for which the value is absent.
    part
        Ratio of the difference to the metric, of an overshoot to the step, of a steady-state
        error to the largest deviation of the event; `inf` if one pass has no such number.
    """

    event: int | None
    event_reason: str | None
    metric: str
    before: float | None
    before_reason: str | None
    after: float | None
    after_reason: str | None
    part: float


class ToleranceCheckAnswer(Record):
    """Difference between the reported run and one at a tenth of its tolerance.

    Attributes
    ----------
    tolerance
        Tolerance of the second run.
    status
        Status of the second run; the comparison extends to its end.
    sample_interval_s
        Time between two compared samples.
    force_difference_n
        Largest magnitude of the difference of the force.
    torque_difference_n_m
        Largest magnitude of the difference of the force.
    force_difference_n_reason
        Reason for which the value is absent.
    torque_difference_n_m_reason
        Reason for which the value is absent.
    part_of_peak
        Ratio of that difference to the largest magnitude of force and reference in both runs.
    part_of_peak_reason
        Reason for which the value is absent.
    signals
        Differences of the command and of all signals of the machine.
    events
        Differences of the metrics of each event.
    """

    tolerance: float
    status: RunStatus
    sample_interval_s: float
    force_difference_n: float | None
    torque_difference_n_m: float | None
    force_difference_n_reason: str | None
    torque_difference_n_m_reason: str | None
    part_of_peak: float | None
    part_of_peak_reason: str | None
    signals: tuple[SignalDifferenceAnswer, ...]
    events: tuple[EventDifferenceAnswer, ...]


class SignalDifferenceAnswer(Record):
    """Largest difference of a signal between two runs, in the SI unit of the signal.

    Attributes
    ----------
    name
        Name of the signal.
    difference
        Largest magnitude of the difference.
    time_s
        Time of that difference.
    peak
        Largest magnitude in both runs and, for the force, of the reference.
    part_of_peak
        Ratio of the difference to the peak; zero if nothing moves.
    """

    name: str
    difference: float
    time_s: float
    peak: float
    part_of_peak: float


class EventDifferenceAnswer(Record):
    """Differences of the metrics of an event between two runs.

    Attributes
    ----------
    kind
        Kind of the event.
    time_s
        Time of the event, from the start of the scenario.
    metrics
        Differences of all metrics.
    """

    kind: Cause
    time_s: float
    metrics: tuple[MetricDifferenceAnswer, ...]


class MetricDifferenceAnswer(Record):
    """Difference of a metric between two runs.

    Attributes
    ----------
    name
        Name of the metric.
    difference
        Magnitude of the difference, in the unit of the metric.
    difference_reason
        Reason for which the value is absent.
    """

    name: str
    difference: float | None
    difference_reason: str | None


class BeyondExpansionAnswer(Record):
    """Chamber above the pressure up to which the expansion of its hose is stated.

    Attributes
    ----------
    chamber
        Chamber, `a` or `b`.
    peak_pressure_pa
        Highest gauge pressure.
    stated_pressure_pa
        Gauge pressure up to which the expansion is stated.
    """

    chamber: str
    peak_pressure_pa: float
    stated_pressure_pa: float


class ChamberGasAnswer(Record):
    """Gas at a chamber over a run.

    Attributes
    ----------
    chamber
        Chamber, `a` or `b`.
    peak_pressure_pa
        Highest gauge pressure.
    temperature_least_ratio
        Ratio of the lowest absolute temperature to that of the wall.
    temperature_least_ratio_reason
        Reason for which the value is absent.
    temperature_peak_ratio
        Ratio of the highest absolute temperature to that of the wall.
    temperature_peak_ratio_reason
        Reason for which the value is absent.
    """

    chamber: str
    peak_pressure_pa: float
    temperature_least_ratio: float | None
    temperature_least_ratio_reason: str | None
    temperature_peak_ratio: float | None
    temperature_peak_ratio_reason: str | None


class RunLedgersAnswer(Record):
    """Accounts of oil and energy over a run; the last of each is that of the whole rig.

    Attributes
    ----------
    oil_m3
        Accounts of oil, in volume at zero gauge pressure except for the volumes of lines and
        gas.
    energy_j
        Accounts of energy.
    """

    oil_m3: tuple[RunAccountAnswer, ...]
    energy_j: tuple[RunAccountAnswer, ...]


class RunAccountAnswer(Record):
    """Account of a part of the rig over a run, in m3 or J.

    Attributes
    ----------
    part
        Part of the rig, or `rig`.
    stored
        Content at the start and at the end.
    inflow
        Net inflow through its ports over the run.
    lost
        Loss over the run: dissipation, or for oil the loss of equations in volumes.
    closing_error
        Increase of the content less the inflow plus the loss, which is zero for an exact
        solution.
    relative_error
        Ratio of the magnitude of the closing error to the integral of the magnitudes of inflow
        and loss; zero if both are zero throughout.
    """

    part: str
    stored: tuple[float, float]
    inflow: float
    lost: float
    closing_error: float
    relative_error: float


class ExceededRigLimitAnswer(Record):
    """Limit of the rig that a run exceeds, with values in the SI unit of the limit.

    Attributes
    ----------
    what
        Kind of the limit.
    limit
        Value of the limit, a gauge pressure if it is a pressure; the one that is exceeded first
        if there are two.
    peak
        Value farthest beyond the limit.
    peak_time_s
        Time of that value.
    first_time_s
        Time at which the limit is first exceeded.
    place
        Part of the rig with the peak.
    place_reason
        Reason for which the value is absent.
    distance_m
        Distance of the peak from the valve in a line, from the piston of the rod in a
        transmission.
    distance_m_reason
        Reason for which the value is absent.
    """

    what: RigLimit
    limit: float
    peak: float
    peak_time_s: float
    first_time_s: float
    place: LimitedPart | None
    place_reason: str | None
    distance_m: float | None
    distance_m_reason: str | None


RigLimit: TypeAlias = Literal["force_sensor_capacity", "stall_force", "nominal_voltage", "vapour_pressure", "working_pressure", "burst_pressure", "laminar_flow", "pump_flow"]
"""Kind of a limit of the rig: the capacity of the force sensor, the force at which the piston stalls, the voltage of full opening, the vapour pressure, the working and the burst pressure of a line, the Reynolds number of laminar flow, or the pressure at which the relief valve of a limited pump is shut."""


LimitedPart: TypeAlias = Literal["chamber_a", "chamber_b", "line_a", "line_b", "neck_a", "neck_b", "transmission"]
"""Part of the rig in which a limit is exceeded; a neck is that of the accumulator at a chamber."""


class ScenarioRequirementAnswer(Record):
    """Requirement in time against the steps of a run.

    Attributes
    ----------
    specification
        Number of the specification, from 1 in the order of the file.
    required
        Required step response.
    verdict
        Outcome for the requirement.
    verdict_reason
        Reason for which the value is absent.
    reached
        Worst step of the run; null without a verdict.
    """

    specification: int
    required: RequiredStepAnswer
    verdict: Satisfaction | None
    verdict_reason: str | None
    reached: WorstStepAnswer | None


class CompareAnswer(Answer):
    """Answer of `compare`.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    projects
        Projects in the order of the command; one at which it was stopped is the last.
    """

    schema: int
    version: str
    command: Literal["compare"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    projects: tuple[ComparedProjectAnswer, ...]


class ComparedProjectAnswer(Record):
    """Runs of one of several projects.

    Attributes
    ----------
    path
        Path of the project file.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    identified
        Values identified from recordings, which replace those of the file.
    scenarios
        Runs in the order of the scenarios in the file.
    not_run
        Names of the scenarios that were not started.
    """

    path: str
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    identified: RecordedAnswer | None
    scenarios: tuple[ScenarioAnswer, ...]
    not_run: tuple[str, ...]


class CampaignAnswer(Answer):
    """Answer of `campaign` about all runs.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    scenario
        Name of the scenario that is run.
    seed
        Seed of all random numbers.
    runs
        Runs of the campaign, counted from 0.
    complete
        True if every run has its row.
    parameters
        Varied numbers.
    statuses
        Number of runs of each status.
    refused
        Runs whose drawn numbers give no machine, or whose machine cannot start.
    early_ends
        Runs that ended early, or diverged.
    occurrences
        Conditions that the machines met, in the order of their first run.
    quantiles_percent
        Percentages of the runs below each of the quantiles.
    metrics
        Metrics of the events of the scenario.
    lumps
        Parameters of the linear models of the drawn machines.
    beyond_box
        Numbers that are drawn beyond the box for which the controller is judged.
    bands
        Quantiles of the force over time.
    requirements
        Requirements in time, each with the number of runs that satisfy it.
    worst_runs
        Runs that are worst in a metric.
    warnings
        Misfits of identified parts, which the runs do not contain, if any.
    """

    schema: int
    version: str
    command: Literal["campaign"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    scenario: str
    seed: int
    runs: CampaignRunsAnswer
    complete: bool
    parameters: tuple[VariedRangeAnswer, ...]
    statuses: CampaignStatusesAnswer
    refused: tuple[RefusedRunAnswer, ...]
    early_ends: tuple[EarlyEndAnswer, ...]
    occurrences: tuple[CampaignOccurrenceAnswer, ...]
    quantiles_percent: tuple[int, int, int, int, int]
    metrics: tuple[CampaignEventAnswer, ...]
    lumps: tuple[CampaignLumpAnswer, ...]
    beyond_box: tuple[BeyondBoxAnswer, ...]
    bands: ForceBandsAnswer
    requirements: tuple[CampaignRequirementAnswer, ...]
    worst_runs: tuple[WorstRunAnswer, ...]
    warnings: tuple[str, ...] | None


class CampaignRunsAnswer(Record):
    """Runs of a campaign.

    Attributes
    ----------
    requested
        Number of requested runs.
    from_
        Index of the first run, 0.
    until
        Index after that of the last run.
    rows
        Number of rows, one of each run that is done.
    """

    requested: int
    from_: int
    until: int
    rows: int


class VariedRangeAnswer(Record):
    """Varied number.

    Attributes
    ----------
    path
        Key of the project file, or `start.` and a state.
    distribution
        Distribution of the number.
    minimum
        Lower end in SI, of a normal distribution two standard deviations below the middle.
    maximum
        Upper end in SI, of a normal distribution two standard deviations above the middle.
    unit
        SI unit of the number; empty for a pure number.
    """

    path: str
    distribution: Distribution
    minimum: float
    maximum: float
    unit: str


Distribution: TypeAlias = Literal["uniform", "normal", "log_uniform", "triangular"]
"""Distribution of a varied number."""


class CampaignStatusesAnswer(Record):
    """Numbers of runs by their status.

    Attributes
    ----------
    completed
        Runs to the end, with numbers that describe the machine.
    diverged
        Runs to the end that diverge.
    not_finite
        Runs that ended because a rate is no longer a number.
    outside_model
        Runs to the end that left the validity of their equations.
    refused
        Runs that were not begun because there is no such machine or it cannot start.
    step_too_small
        Runs that ended because no step is short enough for the tolerance.
    too_many_steps
        Runs that ended because the permitted steps are used up.
    undetermined
        Runs to the end whose repetitions do not agree.
    unresolved_oscillation
        Runs that ended because an oscillation grows that needs more steps than are permitted.
    """

    completed: int
    diverged: int
    not_finite: int
    outside_model: int
    refused: int
    step_too_small: int
    too_many_steps: int
    undetermined: int
    unresolved_oscillation: int


class RefusedRunAnswer(Record):
    """Run without a machine.

    Attributes
    ----------
    run
        Index of the run, from 0.
    reason
        Reason for which there is no machine, or it cannot start.
    """

    run: int
    reason: str


class EarlyEndAnswer(Record):
    """Run that ended early, or diverged.

    Attributes
    ----------
    run
        Index of the run, from 0.
    status
        Status of the run.
    time_s
        Simulated time at which it ended or diverged.
    """

    run: int
    status: RunStatus
    time_s: float


class CampaignOccurrenceAnswer(Record):
    """Condition that machines met.

    Attributes
    ----------
    kind
        Condition.
    runs
        Number of runs with the condition.
    first_run
        First run with the condition, from 0.
    """

    kind: CampaignOccurrenceKind
    runs: int
    first_run: int


CampaignOccurrenceKind: TypeAlias = Literal["cavitation_a", "cavitation_b", "end_stop_a", "end_stop_b", "empty_a", "empty_b", "load_contact", "supply_lost", "accumulator_empty_a", "accumulator_empty_b", "accumulator_overpressure_a", "accumulator_overpressure_b", "series_end", "cavitation_transmission", "relief_valve_a", "relief_valve_b", "check_valve_a", "check_valve_b", "command_limit", "errors_amplified", "repeated", "cavitation_line_a", "cavitation_line_b", "working_pressure_a", "working_pressure_b", "burst_pressure_a", "burst_pressure_b", "turbulent_line_a", "turbulent_line_b", "turbulent_neck_a", "turbulent_neck_b", "turbulent_transmission"]
"""Condition of a machine or of its command in a run, a run that was repeated until its metrics agreed, or one whose errors may be visible."""


class CampaignEventAnswer(Record):
    """Metrics of an event over the runs.

    Attributes
    ----------
    kind
        Kind of the event.
    time_s
        Time of the event, from the start of the scenario.
    until_s
        Time of the next event, or the end of the scenario.
    reference_n
        Reference before and after its step.
    reference_n_m
        Reference before and after its step.
    reference_n_reason
        Reason for which the value is absent.
    reference_n_m_reason
        Reason for which the value is absent.
    command_v
        Open-loop command before and after its step.
    command_v_reason
        Reason for which the value is absent.
    metrics
        Metrics that such an event can have.
    """

    kind: Cause
    time_s: float
    until_s: float
    reference_n: tuple[float, float] | None
    reference_n_m: tuple[float, float] | None
    reference_n_reason: str | None
    reference_n_m_reason: str | None
    command_v: tuple[float, float] | None
    command_v_reason: str | None
    metrics: tuple[CampaignMetricAnswer, ...]


class CampaignMetricAnswer(Record):
    """Metric over the runs.

    Attributes
    ----------
    name
        Name of the metric.
    count
        Number of runs that have one.
    missing
        Number of runs that could have one and do not.
    quantiles
        Quantiles by `quantiles_percent`, interpolated linearly between two runs; null if no run
        has one.
    minimum
        Least number; null if no run has one.
    maximum
        Greatest number; null if no run has one.
    worst
        Number of largest magnitude; null if no run has one.
    reason
        Reason for the absence of the numbers; null if a run has one.
    """

    name: str
    count: int
    missing: int
    quantiles: tuple[float, float, float, float, float] | None
    minimum: float | None
    maximum: float | None
    worst: WorstNumberAnswer | None
    reason: str | None


class WorstNumberAnswer(Record):
    """Number of largest magnitude over the runs.

    Attributes
    ----------
    value
        Number in SI.
    run
        Index of the run, from 0.
    """

    value: float
    run: int


class CampaignLumpAnswer(Record):
    """Parameter of the linear models of the drawn machines.

    Attributes
    ----------
    name
        Name of the parameter: `hydraulic_stiffness`, `flow_gain` or
        `flow_pressure_coefficient`.
    bounds
        Bounds of the parameter in the family, from low to high.
    bounds_reason
        Reason for which the value is absent.
    outside
        Number of runs whose machine is outside the bounds; null without bounds.
    count
        Number of runs that have one.
    missing
        Number of runs that could have one and do not.
    quantiles
        Quantiles by `quantiles_percent`, interpolated linearly between two runs; null if no run
        has one.
    minimum
        Least number; null if no run has one.
    maximum
        Greatest number; null if no run has one.
    worst
        Number of largest magnitude; null if no run has one.
    reason
        Reason for the absence of the numbers; null if a run has one.
    """

    name: str
    bounds: Interval | None
    bounds_reason: str | None
    outside: int | None
    count: int
    missing: int
    quantiles: tuple[float, float, float, float, float] | None
    minimum: float | None
    maximum: float | None
    worst: WorstNumberAnswer | None
    reason: str | None


class BeyondBoxAnswer(Record):
    """Number that is drawn beyond the box for which the controller is judged.

    Attributes
    ----------
    path
        Key of the project file.
    minimum
        Lower end of the draws in SI, of a normal distribution two standard deviations below the
        middle.
    maximum
        Upper end of the draws in SI, of a normal distribution two standard deviations above the
        middle.
    box
        Range in the box, from low to high.
    box_reason
        Reason for which the value is absent.
    """

    path: str
    minimum: float
    maximum: float
    box: Interval | None
    box_reason: str | None


class ForceBandsAnswer(Record):
    """Quantiles of the force over time, of all runs that lasted until then.

    Attributes
    ----------
    time_s
        Times of the values.
    force_n
        Force at these times, a list for each of `quantiles_percent`.
    torque_n_m
        Force at these times, a list for each of `quantiles_percent`.
    """

    time_s: tuple[float, ...]
    force_n: tuple[tuple[float, ...], ...] | None
    torque_n_m: tuple[tuple[float, ...], ...] | None


class CampaignRequirementAnswer(Record):
    """Requirement in time, with the number of runs that satisfy it.

    Attributes
    ----------
    specification
        Number of the specification, from 1 in the order of the file.
    requirement
        Requirement in words.
    required
        Required step response.
    satisfied
        Number of runs all of whose steps satisfy it.
    satisfied_reason
        Reason for which the value is absent.
    runs
        Number of simulated runs; one that is not completed does not satisfy it.
    runs_reason
        Reason for which the value is absent.
    confidence_95
        Confidence interval of 95 % for the probability that a run satisfies it, from low to
        high, by Wilson.
    confidence_95_reason
        Reason for which the value is absent.
    worst
        Run that is furthest from the requirement, if there is a run.
    """

    specification: int
    requirement: str
    required: RequiredStepAnswer
    satisfied: int | None
    satisfied_reason: str | None
    runs: int | None
    runs_reason: str | None
    confidence_95: Interval | None
    confidence_95_reason: str | None
    worst: FurthestRunAnswer | None


class FurthestRunAnswer(Record):
    """Run that is furthest from a requirement in time.

    Attributes
    ----------
    run
        Index of the run, from 0.
    reached
        Worst step of the run.
    """

    run: int
    reached: WorstStepAnswer


class WorstRunAnswer(Record):
    """Run that is worst in a metric.

    Attributes
    ----------
    run
        Index of the run, from 0.
    of
        Events and metrics in which it is worst, such as `event 1 overshoot_percent`.
    settings
        Drawn numbers of the run, as settings `path=value` of the project.
    """

    run: int
    of: tuple[str, ...]
    settings: tuple[str, ...]


class CampaignRunAnswer(Answer):
    """Answer of `campaign` about one run.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    scenario
        Name of the scenario that is run.
    seed
        Seed of all random numbers.
    run
        Index of the run, from 0.
    run_settings
        Drawn numbers of the run, as settings `path=value` of the project.
    scenarios
        Runs in the order of the scenarios in the file.
    not_run
        Names of the scenarios that were not started.
    warnings
        Misfits of identified parts, which the run does not contain, if any.
    """

    schema: int
    version: str
    command: Literal["campaign"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    scenario: str
    seed: int
    run: int
    run_settings: tuple[str, ...]
    scenarios: tuple[ScenarioAnswer, ...]
    not_run: tuple[str, ...]
    warnings: tuple[str, ...] | None


class AlternativesAnswer(Answer):
    """Answer of `alternatives`.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    alternatives
        Project as it is declared, then its alternatives in the order of the file.
    not_reached
        Names of the alternatives that were not finished when the command was stopped.
    warnings
        Declared effects that the verdicts do not include.
    findings
        Comparison of the alternatives in sentences.
    load_cases
        Same alternatives in each load case.
    front
        Alternatives over a swept key, if a front was requested.
    """

    schema: int
    version: str
    command: Literal["alternatives"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    alternatives: tuple[AlternativeAnswer, ...]
    not_reached: tuple[str, ...]
    warnings: tuple[str, ...]
    findings: tuple[str, ...]
    load_cases: tuple[LoadCaseAnswer, ...]
    front: FrontAnswer | None


class AlternativeAnswer(Record):
    """Alternative with its own design.

    Attributes
    ----------
    name
        Name of the alternative.
    settings
        Settings of the alternative, each `path=value`.
    moved_ranges
        Ranges of `[uncertainty]` that follow the rig of the alternative.
    verdict
        Verdict on the designed controller over the family.
    verdict_reason
        Reason for which the value is absent.
    design
        Design, as `design` returns it.
    design_reason
        Reason for which the value is absent.
    machine
        Designed controller on the nonlinear machine.
    machine_reason
        Reason for which the value is absent.
    columns
        Numbers by which alternatives are compared.
    """

    name: str
    settings: tuple[str, ...]
    moved_ranges: tuple[MovedRangeAnswer, ...]
    verdict: Verdict | None
    verdict_reason: str | None
    design: DesignAnswer | None
    design_reason: str | None
    machine: TrialAnswer | None
    machine_reason: str | None
    columns: AlternativeColumnsAnswer


class MovedRangeAnswer(Record):
    """Range of an uncertain parameter, moved in proportion to its derived value.

    Attributes
    ----------
    name
        Name of the parameter.
    stated
        Range as the project states it.
    moved
        Range of the alternative.
    """

    name: str
    stated: ParameterRangeAnswer
    moved: ParameterRangeAnswer


class ParameterRangeAnswer(Record):
    """Range of a parameter in SI.

    Attributes
    ----------
    nominal
        Nominal value.
    minimum
        Least value.
    maximum
        Greatest value.
    """

    nominal: float
    minimum: float
    maximum: float


class DesignAnswer(Record):
    """Answer of `design`.

    Attributes
    ----------
    status
        Outcome of the design.
    unusable
        Reason not to use the designed controller, only if there is one.
    unfinished
        Parts that were not finished because the design was stopped.
    objective
        Objective of the search.
    seed
        Seed of the pseudo-random numbers of the search.
    controller
        Designed controller G; of a sampled loop in z.
    prefilter
        Prefilter F of the designed loop; of a sampled loop in z.
    prefilter_reason
        Reason for which the value is absent.
    pressure_feedback
        Pressure feedback that was designed before the loop, only if `design.pressure_feedback`
        is free.
    continuous_law
        Controller and prefilter before they are sampled, only of a sampled loop whose
        controller is a continuous law.
    figures
        Figures by which controllers are compared.
    structure
        Structure of the designed controller.
    manual
        Designed controller in the terms of a controller's manual, before it is sampled.
    manual_reason
        Reason for which the value is absent.
    structures
        Structures that were designed, in the order of the search.
    led_by
        Requirements that led the last search.
    earned_per_pole_db
        Reduction of the compared quantity that each further pole must bring, `inf` if no longer
        structure replaces a shorter one; only if several named structures are designed.
    verification
        Audit of the designed controller over the family and the frequency band.
    published
        Controller that the project gives, with its audit; null if there is none, for the reason
        in `published_reason`.
    continuous_as_sampled
        Controller that was designed without sampling, sampled and audited like the loop, only
        of a sampled loop.
    minimum_delay_margin_s
        Least additional delay that every plant must tolerate.
    limits
        Limits in addition to the specifications.
    reserve_db
        Margin of the search to every limit, for what lies between its plants and frequencies.
    published_reason
        Reason for the absence of `published`.
    rounds
        Rounds of search and audit.
    starts
        Starts of the last search.
    starts_reason
        Reason for which the value is absent.
    binding
        Limits over frequency that bind.
    relaxations
        Gain from relaxing each limit that binds.
    relaxation_db
        Amount by which every limit must be relaxed for a controller to satisfy it.
    relaxation_db_reason
        Reason for which the value is absent.
    conflicts
        Limits that conflict at this relaxation; empty unless the specifications are infeasible.
    explanations
        Facts that are impossible or hard for any controller.
    rounding
        Effect of the converters of the controller's computer, only if a converter rounds.
    machine
        Designed controller on the nonlinear machine.
    machine_reason
        Reason for which the value is absent.
    repair
        Repair of the design, only if the machine contradicts it and a repair was requested.
    repair_reason
        Reason for which the value is absent.
    """

    status: DesignOutcomeKind
    unusable: str | None
    unfinished: tuple[DesignPart, ...]
    objective: ObjectiveAnswer
    seed: int
    controller: FactoredLawAnswer
    prefilter: FactoredLawAnswer | None
    prefilter_reason: str | None
    pressure_feedback: PressureFeedbackAnswer | None
    continuous_law: ContinuousLawAnswer | None
    figures: LoopFiguresAnswer
    structure: StructureAnswer
    manual: ManualAnswer | None
    manual_reason: str | None
    structures: tuple[ReachedStructureAnswer, ...]
    led_by: LedBy
    earned_per_pole_db: float | None
    verification: AuditAnswer
    published: AuditedControllerAnswer | None
    continuous_as_sampled: AuditedControllerAnswer | None
    minimum_delay_margin_s: float
    limits: tuple[DesignLimitAnswer, ...]
    reserve_db: float
    published_reason: str | None
    rounds: tuple[DesignRoundAnswer, ...]
    starts: SearchStartsAnswer | None
    starts_reason: str | None
    binding: tuple[BindingLimitAnswer, ...]
    relaxations: tuple[RelaxationAnswer, ...]
    relaxation_db: float | None
    relaxation_db_reason: str | None
    conflicts: tuple[BindingLimitAnswer, ...]
    explanations: tuple[ExplanationAnswer, ...]
    rounding: RoundingAnswer | None
    machine: TrialAnswer | None
    machine_reason: str | None
    repair: RepairAnswer | None
    repair_reason: str | None


class AlternativeColumnsAnswer(Record):
    """Numbers by which alternatives are compared.

    Attributes
    ----------
    feasible
        True if the designed loop satisfies every specification and the nonlinear rig every
        requirement in time.
    feasible_reason
        Reason for which the value is absent.
    stable_with_its_load
        Verdict on the stability of the designed loop with the load of the alternative.
    stable_with_its_load_reason
        Reason for which the value is absent.
    relaxation_db
        Relaxation of every limit with which the specifications can be satisfied; 0 if they are
        satisfied.
    relaxation_db_reason
        Reason for which the value is absent.
    order
        Order of the controller.
    order_reason
        Reason for which the value is absent.
    prefilter_order
        Order of the prefilter.
    prefilter_order_reason
        Reason for which the value is absent.
    relative_degree
        Relative degree of the controller.
    relative_degree_reason
        Reason for which the value is absent.
    high_frequency_gain_db
        High-frequency gain of the controller.
    high_frequency_gain_db_reason
        Reason for which the value is absent.
    modulus_margin
        Modulus margin of the designed loop.
    modulus_margin_reason
        Reason for which the value is absent.
    delay_margin_s
        Delay margin of the designed loop.
    delay_margin_s_reason
        Reason for which the value is absent.
    stiffness_minimum_n_per_m
        Least hydraulic stiffness over the stroke.
    stiffness_minimum_n_m_per_rad
        Least hydraulic stiffness over the stroke.
    stiffness_minimum_n_per_m_reason
        Reason for which the value is absent.
    stiffness_minimum_n_m_per_rad_reason
        Reason for which the value is absent.
    stiffness_maximum_n_per_m
        Greatest hydraulic stiffness over the stroke.
    stiffness_maximum_n_m_per_rad
        Greatest hydraulic stiffness over the stroke.
    stiffness_maximum_n_per_m_reason
        Reason for which the value is absent.
    stiffness_maximum_n_m_per_rad_reason
        Reason for which the value is absent.
    equivalent_stiffness_n_per_m
        Stiffness of oil and force sensor in series at the operating point.
    equivalent_stiffness_n_m_per_rad
        Stiffness of oil and force sensor in series at the operating point.
    equivalent_stiffness_n_per_m_reason
        Reason for which the value is absent.
    equivalent_stiffness_n_m_per_rad_reason
        Reason for which the value is absent.
    actuator_length_m
        Retracted length of the actuator.
    actuator_length_m_reason
        Reason for which the value is absent.
    lines_length_m
        Length of both lines together.
    lines_length_m_reason
        Reason for which the value is absent.
    moving_mass_kg
        Moving mass or inertia of the actuator.
    moving_inertia_kg_m2
        Moving mass or inertia of the actuator.
    moving_mass_kg_reason
        Reason for which the value is absent.
    moving_inertia_kg_m2_reason
        Reason for which the value is absent.
    lines_volume_m3
        Volume of the oil in both lines.
    lines_volume_m3_reason
        Reason for which the value is absent.
    oil_volume_m3
        Volume of the oil in lines, chambers, accumulators and a transmission.
    oil_volume_m3_reason
        Reason for which the value is absent.
    oil_mass_kg
        Mass of that oil.
    oil_mass_kg_reason
        Reason for which the value is absent.
    gas_volume_m3
        Volume of the gas of the accumulators at the chambers, at their precharge.
    gas_volume_m3_reason
        Reason for which the value is absent.
    power_at_rest_w
        Hydraulic power of the rig at rest.
    power_at_rest_w_reason
        Reason for which the value is absent.
    parts_price
        Price of the parts, in the currency `parts_currency`.
    parts_price_reason
        Reason for which the value is absent.
    parts_mass_kg
        Mass of the parts and of the oil in the lines.
    parts_mass_kg_reason
        Reason for which the value is absent.
    sized_length_m
        Length of line A of the best hose by `[sizing]`.
    sized_length_m_reason
        Reason for which the value is absent.
    sized_gain_v_per_n
        Proportional gain with the best hose by `[sizing]`.
    sized_gain_v_per_n_m
        Proportional gain with the best hose by `[sizing]`.
    sized_gain_v_per_n_reason
        Reason for which the value is absent.
    sized_gain_v_per_n_m_reason
        Reason for which the value is absent.
    parts_currency
        ISO 4217 code of the currency of the prices, if a price is stated.
    specifications
        Specifications in the order of the file; empty if there is no design.
    scenarios
        Scenarios with the designed controller.
    impedance
        Driving-point impedance at the load at each requested frequency.
    passivity
        Passivity of the driving-point impedance at the load.
    """

    feasible: bool | None
    feasible_reason: str | None
    stable_with_its_load: Verdict | None
    stable_with_its_load_reason: str | None
    relaxation_db: float | None
    relaxation_db_reason: str | None
    order: int | None
    order_reason: str | None
    prefilter_order: int | None
    prefilter_order_reason: str | None
    relative_degree: int | None
    relative_degree_reason: str | None
    high_frequency_gain_db: float | None
    high_frequency_gain_db_reason: str | None
    modulus_margin: float | None
    modulus_margin_reason: str | None
    delay_margin_s: float | None
    delay_margin_s_reason: str | None
    stiffness_minimum_n_per_m: float | None
    stiffness_minimum_n_m_per_rad: float | None
    stiffness_minimum_n_per_m_reason: str | None
    stiffness_minimum_n_m_per_rad_reason: str | None
    stiffness_maximum_n_per_m: float | None
    stiffness_maximum_n_m_per_rad: float | None
    stiffness_maximum_n_per_m_reason: str | None
    stiffness_maximum_n_m_per_rad_reason: str | None
    equivalent_stiffness_n_per_m: float | None
    equivalent_stiffness_n_m_per_rad: float | None
    equivalent_stiffness_n_per_m_reason: str | None
    equivalent_stiffness_n_m_per_rad_reason: str | None
    actuator_length_m: float | None
    actuator_length_m_reason: str | None
    lines_length_m: float | None
    lines_length_m_reason: str | None
    moving_mass_kg: float | None
    moving_inertia_kg_m2: float | None
    moving_mass_kg_reason: str | None
    moving_inertia_kg_m2_reason: str | None
    lines_volume_m3: float | None
    lines_volume_m3_reason: str | None
    oil_volume_m3: float | None
    oil_volume_m3_reason: str | None
    oil_mass_kg: float | None
    oil_mass_kg_reason: str | None
    gas_volume_m3: float | None
    gas_volume_m3_reason: str | None
    power_at_rest_w: float | None
    power_at_rest_w_reason: str | None
    parts_price: float | None
    parts_price_reason: str | None
    parts_mass_kg: float | None
    parts_mass_kg_reason: str | None
    sized_length_m: float | None
    sized_length_m_reason: str | None
    sized_gain_v_per_n: float | None
    sized_gain_v_per_n_m: float | None
    sized_gain_v_per_n_reason: str | None
    sized_gain_v_per_n_m_reason: str | None
    parts_currency: str | None
    specifications: tuple[SpecificationColumnsAnswer, ...]
    scenarios: tuple[ScenarioColumnsAnswer, ...]
    impedance: tuple[ImpedanceColumnsAnswer, ...]
    passivity: AlternativePassivityAnswer


class SpecificationColumnsAnswer(Record):
    """Margin to a specification.

    Attributes
    ----------
    name
        Name of the specification.
    worst_margin_db
        Least margin to the specification.
    worst_margin_db_reason
        Reason for which the value is absent.
    """

    name: str
    worst_margin_db: float | None
    worst_margin_db_reason: str | None


class ScenarioColumnsAnswer(Record):
    """Greatest values of all events of a scenario.

    Attributes
    ----------
    name
        Name of the scenario.
    overshoot_percent
        Greatest overshoot, of the step.
    overshoot_percent_reason
        Reason for which the value is absent.
    settling_time_s
        Longest settling time.
    settling_time_s_reason
        Reason for which the value is absent.
    disturbance_peak_n
        Greatest deviation of the force or torque after a disturbance.
    disturbance_peak_n_m
        Greatest deviation of the force or torque after a disturbance.
    disturbance_peak_n_reason
        Reason for which the value is absent.
    disturbance_peak_n_m_reason
        Reason for which the value is absent.
    control_peak_v
        Greatest magnitude of the command.
    control_peak_v_reason
        Reason for which the value is absent.
    control_rms_v
        Greatest root mean square of the command.
    control_rms_v_reason
        Reason for which the value is absent.
    energy_from_supply_j
        Energy from the supply over the scenario, including the tare flow.
    energy_from_supply_j_reason
        Reason for which the value is absent.
    """

    name: str
    overshoot_percent: float | None
    overshoot_percent_reason: str | None
    settling_time_s: float | None
    settling_time_s_reason: str | None
    disturbance_peak_n: float | None
    disturbance_peak_n_m: float | None
    disturbance_peak_n_reason: str | None
    disturbance_peak_n_m_reason: str | None
    control_peak_v: float | None
    control_peak_v_reason: str | None
    control_rms_v: float | None
    control_rms_v_reason: str | None
    energy_from_supply_j: float | None
    energy_from_supply_j_reason: str | None


class ImpedanceColumnsAnswer(Record):
    """Driving-point impedance at the load at one frequency.

    Attributes
    ----------
    frequency_rad_per_s
        Frequency of the impedance.
    impedance_open_n_s_per_m
        Magnitude with constant command.
    impedance_open_n_m_s_per_rad
        Magnitude with constant command.
    impedance_open_n_s_per_m_reason
        Reason for which the value is absent.
    impedance_open_n_m_s_per_rad_reason
        Reason for which the value is absent.
    impedance_closed_n_s_per_m
        Magnitude with the designed controller.
    impedance_closed_n_m_s_per_rad
        Magnitude with the designed controller.
    impedance_closed_n_s_per_m_reason
        Reason for which the value is absent.
    impedance_closed_n_m_s_per_rad_reason
        Reason for which the value is absent.
    impedance_required_n_s_per_m
        Magnitude of the required virtual impedance, if there is one.
    impedance_required_n_m_s_per_rad
        Magnitude of the required virtual impedance, if there is one.
    impedance_required_n_s_per_m_reason
        Reason for which the value is absent.
    impedance_required_n_m_s_per_rad_reason
        Reason for which the value is absent.
    """

    frequency_rad_per_s: float
    impedance_open_n_s_per_m: float | None
    impedance_open_n_m_s_per_rad: float | None
    impedance_open_n_s_per_m_reason: str | None
    impedance_open_n_m_s_per_rad_reason: str | None
    impedance_closed_n_s_per_m: float | None
    impedance_closed_n_m_s_per_rad: float | None
    impedance_closed_n_s_per_m_reason: str | None
    impedance_closed_n_m_s_per_rad_reason: str | None
    impedance_required_n_s_per_m: float | None
    impedance_required_n_m_s_per_rad: float | None
    impedance_required_n_s_per_m_reason: str | None
    impedance_required_n_m_s_per_rad_reason: str | None


class AlternativePassivityAnswer(Record):
    """Passivity of the driving-point impedance at the load.

    Attributes
    ----------
    open_loop
        Passivity with constant command.
    open_loop_reason
        Reason for which the value is absent.
    closed_loop
        Passivity with the designed controller.
    closed_loop_reason
        Reason for which the value is absent.
    """

    open_loop: PassivityAnswer | None
    open_loop_reason: str | None
    closed_loop: PassivityAnswer | None
    closed_loop_reason: str | None


class LoadCaseAnswer(Record):
    """Alternatives in a load case.

    Attributes
    ----------
    name
        Name of the load case.
    settings
        Settings of the load case, each `path=value`.
    alternatives
        Project as it is declared, then its alternatives in the order of the file.
    not_reached
        Names of the alternatives that were not finished when the command was stopped.
    findings
        Comparison of the alternatives in sentences.
    """

    name: str
    settings: tuple[str, ...]
    alternatives: tuple[AlternativeAnswer, ...]
    not_reached: tuple[str, ...]
    findings: tuple[str, ...]


class FrontAnswer(Record):
    """Alternatives over a swept key, with their front of Pareto.

    Attributes
    ----------
    key
        Path of the swept key.
    unit
        Unit of its values.
    columns
        Columns by which the points are compared.
    points
        Points of each alternative.
    not_reached
        Number of points that were not finished when the command was stopped.
    findings
        Front in sentences, with the cost of each step along it.
    """

    key: str
    unit: str
    columns: tuple[FrontColumnAnswer, ...]
    points: tuple[FrontPointAnswer, ...]
    not_reached: int
    findings: tuple[str, ...]


class FrontColumnAnswer(Record):
    """Column by which the points are compared.

    Attributes
    ----------
    key
        Key of the column in a point.
    better
        Better one of two values.
    """

    key: str
    better: ColumnSense


ColumnSense: TypeAlias = Literal["more", "less"]
"""Better one of two values of a column, the greater or the lesser."""


class FrontPointAnswer(Record):
    """Alternative at one value of the swept key.

    Attributes
    ----------
    alternative
        Name of the alternative.
    value
        Value of the swept key.
    feasible
        True if every specification is satisfied.
    feasible_reason
        Reason for which the value is absent.
    comparable
        True if the point is compared with others.
    relaxation_db
        Relaxation of every limit with which the specifications can be satisfied; 0 if they are
        satisfied.
    relaxation_db_reason
        Reason for which the value is absent.
    order
        Order of the controller.
    order_reason
        Reason for which the value is absent.
    prefilter_order
        Order of the prefilter.
    prefilter_order_reason
        Reason for which the value is absent.
    relative_degree
        Relative degree of the controller.
    relative_degree_reason
        Reason for which the value is absent.
    high_frequency_gain_db
        High-frequency gain of the controller.
    high_frequency_gain_db_reason
        Reason for which the value is absent.
    modulus_margin
        Modulus margin of the designed loop.
    modulus_margin_reason
        Reason for which the value is absent.
    delay_margin_s
        Delay margin of the designed loop.
    delay_margin_s_reason
        Reason for which the value is absent.
    worst_margin_db
        Least margin to the specification.
    worst_margin_db_reason
        Reason for which the value is absent.
    stiffness_minimum_n_per_m
        Least hydraulic stiffness over the stroke.
    stiffness_minimum_n_m_per_rad
        Least hydraulic stiffness over the stroke.
    stiffness_minimum_n_per_m_reason
        Reason for which the value is absent.
    stiffness_minimum_n_m_per_rad_reason
        Reason for which the value is absent.
    stiffness_maximum_n_per_m
        Greatest hydraulic stiffness over the stroke.
    stiffness_maximum_n_m_per_rad
        Greatest hydraulic stiffness over the stroke.
    stiffness_maximum_n_per_m_reason
        Reason for which the value is absent.
    stiffness_maximum_n_m_per_rad_reason
        Reason for which the value is absent.
    equivalent_stiffness_n_per_m
        Stiffness of oil and force sensor in series at the operating point.
    equivalent_stiffness_n_m_per_rad
        Stiffness of oil and force sensor in series at the operating point.
    equivalent_stiffness_n_per_m_reason
        Reason for which the value is absent.
    equivalent_stiffness_n_m_per_rad_reason
        Reason for which the value is absent.
    actuator_length_m
        Retracted length of the actuator.
    actuator_length_m_reason
        Reason for which the value is absent.
    lines_length_m
        Length of both lines together.
    lines_length_m_reason
        Reason for which the value is absent.
    moving_mass_kg
        Moving mass or inertia of the actuator.
    moving_inertia_kg_m2
        Moving mass or inertia of the actuator.
    moving_mass_kg_reason
        Reason for which the value is absent.
    moving_inertia_kg_m2_reason
        Reason for which the value is absent.
    lines_volume_m3
        Volume of the oil in both lines.
    lines_volume_m3_reason
        Reason for which the value is absent.
    oil_volume_m3
        Volume of the oil in lines, chambers, accumulators and a transmission.
    oil_volume_m3_reason
        Reason for which the value is absent.
    oil_mass_kg
        Mass of that oil.
    oil_mass_kg_reason
        Reason for which the value is absent.
    gas_volume_m3
        Volume of the gas of the accumulators at the chambers, at their precharge.
    gas_volume_m3_reason
        Reason for which the value is absent.
    power_at_rest_w
        Hydraulic power of the rig at rest.
    power_at_rest_w_reason
        Reason for which the value is absent.
    parts_price
        Price of the parts, in the currency `parts_currency`.
    parts_price_reason
        Reason for which the value is absent.
    parts_mass_kg
        Mass of the parts and of the oil in the lines.
    parts_mass_kg_reason
        Reason for which the value is absent.
    sized_length_m
        Length of line A of the best hose by `[sizing]`.
    sized_length_m_reason
        Reason for which the value is absent.
    sized_gain_v_per_n
        Proportional gain with the best hose by `[sizing]`.
    sized_gain_v_per_n_m
        Proportional gain with the best hose by `[sizing]`.
    sized_gain_v_per_n_reason
        Reason for which the value is absent.
    sized_gain_v_per_n_m_reason
        Reason for which the value is absent.
    impedance_open_n_s_per_m
        Magnitude with constant command.
    impedance_open_n_m_s_per_rad
        Magnitude with constant command.
    impedance_open_n_s_per_m_reason
        Reason for which the value is absent.
    impedance_open_n_m_s_per_rad_reason
        Reason for which the value is absent.
    impedance_closed_n_s_per_m
        Magnitude with the designed controller.
    impedance_closed_n_m_s_per_rad
        Magnitude with the designed controller.
    impedance_closed_n_s_per_m_reason
        Reason for which the value is absent.
    impedance_closed_n_m_s_per_rad_reason
        Reason for which the value is absent.
    impedance_required_n_s_per_m
        Magnitude of the required virtual impedance, if there is one.
    impedance_required_n_m_s_per_rad
        Magnitude of the required virtual impedance, if there is one.
    impedance_required_n_s_per_m_reason
        Reason for which the value is absent.
    impedance_required_n_m_s_per_rad_reason
        Reason for which the value is absent.
    overshoot_percent
        Greatest overshoot, of the step.
    overshoot_percent_reason
        Reason for which the value is absent.
    settling_time_s
        Longest settling time.
    settling_time_s_reason
        Reason for which the value is absent.
    disturbance_peak_n
        Greatest deviation of the force or torque after a disturbance.
    disturbance_peak_n_m
        Greatest deviation of the force or torque after a disturbance.
    disturbance_peak_n_reason
        Reason for which the value is absent.
    disturbance_peak_n_m_reason
        Reason for which the value is absent.
    control_peak_v
        Greatest magnitude of the command.
    control_peak_v_reason
        Reason for which the value is absent.
    control_rms_v
        Greatest root mean square of the command.
    control_rms_v_reason
        Reason for which the value is absent.
    energy_from_supply_j
        Energy from the supply over the scenario, including the tare flow.
    energy_from_supply_j_reason
        Reason for which the value is absent.
    swept
        Value of the swept key.
    swept_reason
        Reason for which the value is absent.
    on_front
        True if no other point dominates this one.
    dominated_by
        Places in the list of the points that dominate it, from 0.
    """

    alternative: str
    value: float
    feasible: bool | None
    feasible_reason: str | None
    comparable: bool
    relaxation_db: float | None
    relaxation_db_reason: str | None
    order: float | None
    order_reason: str | None
    prefilter_order: float | None
    prefilter_order_reason: str | None
    relative_degree: float | None
    relative_degree_reason: str | None
    high_frequency_gain_db: float | None
    high_frequency_gain_db_reason: str | None
    modulus_margin: float | None
    modulus_margin_reason: str | None
    delay_margin_s: float | None
    delay_margin_s_reason: str | None
    worst_margin_db: float | None
    worst_margin_db_reason: str | None
    stiffness_minimum_n_per_m: float | None
    stiffness_minimum_n_m_per_rad: float | None
    stiffness_minimum_n_per_m_reason: str | None
    stiffness_minimum_n_m_per_rad_reason: str | None
    stiffness_maximum_n_per_m: float | None
    stiffness_maximum_n_m_per_rad: float | None
    stiffness_maximum_n_per_m_reason: str | None
    stiffness_maximum_n_m_per_rad_reason: str | None
    equivalent_stiffness_n_per_m: float | None
    equivalent_stiffness_n_m_per_rad: float | None
    equivalent_stiffness_n_per_m_reason: str | None
    equivalent_stiffness_n_m_per_rad_reason: str | None
    actuator_length_m: float | None
    actuator_length_m_reason: str | None
    lines_length_m: float | None
    lines_length_m_reason: str | None
    moving_mass_kg: float | None
    moving_inertia_kg_m2: float | None
    moving_mass_kg_reason: str | None
    moving_inertia_kg_m2_reason: str | None
    lines_volume_m3: float | None
    lines_volume_m3_reason: str | None
    oil_volume_m3: float | None
    oil_volume_m3_reason: str | None
    oil_mass_kg: float | None
    oil_mass_kg_reason: str | None
    gas_volume_m3: float | None
    gas_volume_m3_reason: str | None
    power_at_rest_w: float | None
    power_at_rest_w_reason: str | None
    parts_price: float | None
    parts_price_reason: str | None
    parts_mass_kg: float | None
    parts_mass_kg_reason: str | None
    sized_length_m: float | None
    sized_length_m_reason: str | None
    sized_gain_v_per_n: float | None
    sized_gain_v_per_n_m: float | None
    sized_gain_v_per_n_reason: str | None
    sized_gain_v_per_n_m_reason: str | None
    impedance_open_n_s_per_m: float | None
    impedance_open_n_m_s_per_rad: float | None
    impedance_open_n_s_per_m_reason: str | None
    impedance_open_n_m_s_per_rad_reason: str | None
    impedance_closed_n_s_per_m: float | None
    impedance_closed_n_m_s_per_rad: float | None
    impedance_closed_n_s_per_m_reason: str | None
    impedance_closed_n_m_s_per_rad_reason: str | None
    impedance_required_n_s_per_m: float | None
    impedance_required_n_m_s_per_rad: float | None
    impedance_required_n_s_per_m_reason: str | None
    impedance_required_n_m_s_per_rad_reason: str | None
    overshoot_percent: float | None
    overshoot_percent_reason: str | None
    settling_time_s: float | None
    settling_time_s_reason: str | None
    disturbance_peak_n: float | None
    disturbance_peak_n_m: float | None
    disturbance_peak_n_reason: str | None
    disturbance_peak_n_m_reason: str | None
    control_peak_v: float | None
    control_peak_v_reason: str | None
    control_rms_v: float | None
    control_rms_v_reason: str | None
    energy_from_supply_j: float | None
    energy_from_supply_j_reason: str | None
    swept: float | None
    swept_reason: str | None
    on_front: bool
    dominated_by: tuple[int, ...]


class BenchAnswer(Answer):
    """Answer of `bench`.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    remarks
        Remarks on the parts of the project that the tests leave out, if any.
    tests
        Static tests of the servovalve.
    line_tests
        Tests of a blocked line, if `[bench.line]` requests them.
    friction_runs
        Runs of the cylinder for its friction, if `[bench.friction]` requests them.
    """

    schema: int
    version: str
    command: Literal["bench"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    remarks: tuple[str, ...] | None
    tests: tuple[BenchTestAnswer, ...]
    line_tests: tuple[LineTestTableAnswer, ...] | None
    friction_runs: tuple[BenchRecordAnswer, ...] | None


class BenchTestAnswer(Record):
    """Static test of the servovalve.

    Attributes
    ----------
    name
        Name of the test.
    file
        Name of the file with its rows.
    rows
        Number of rows.
    duration_s
        Time of the last row from the start.
    signals
        Recorded signals.
    lowest_supply_pressure_pa
        Lowest supply pressure during the test, without noise.
    reversals
        Hysteresis and threshold of the valve, only of the test of reversals.
    """

    name: str
    file: str
    rows: int
    duration_s: float
    signals: tuple[BenchSignalAnswer, ...]
    lowest_supply_pressure_pa: float
    reversals: ReversalsAnswer | None


class BenchSignalAnswer(Record):
    """Recorded signal of a virtual test.

    Attributes
    ----------
    name
        Name of the quantity.
    unit
        SI unit of the range, not of the file; degrees Celsius of a temperature.
    range
        Smallest and largest value.
    """

    name: str
    unit: str
    range: Interval


class ReversalsAnswer(Record):
    """Hysteresis and threshold of the valve, as the rows of the test show them.

    Attributes
    ----------
    hysteresis_v
        Greatest difference of two commands with the same flow over the cycle, including the
        threshold.
    threshold_v
        Change of the command after a reversal before the spool moves.
    hysteresis_fraction_of_nominal
        Hysteresis over the command of full opening.
    threshold_fraction_of_nominal
        Threshold over the command of full opening.
    """

    hysteresis_v: BenchEstimateAnswer
    threshold_v: BenchEstimateAnswer
    hysteresis_fraction_of_nominal: float
    threshold_fraction_of_nominal: float


class BenchEstimateAnswer(Record):
    """Estimate of a number.

    Attributes
    ----------
    value
        Most likely value.
    confidence_95
        Bounds of the 95 % confidence interval; infinite if nothing limits it.
    """

    value: float
    confidence_95: Interval


class LineTestTableAnswer(Record):
    """Test of a blocked line.

    Attributes
    ----------
    name
        Name of the test.
    file
        Name of the file with its rows.
    rows
        Number of rows.
    duration_s
        Time of the last row from the start.
    volume_m3
        Smallest and largest volume displaced into the line, only of a slow pressure rise.
    flow_m3_per_s
        Smallest and largest flow into the line, only of a frequency response.
    pressure_pa
        Smallest and largest pressure at the open end.
    """

    name: str
    file: str
    rows: int
    duration_s: float
    volume_m3: Interval | None
    flow_m3_per_s: Interval | None
    pressure_pa: Interval


class BenchRecordAnswer(Record):
    """Record of a virtual test.

    Attributes
    ----------
    name
        Name of the test.
    file
        Name of the file with its rows.
    rows
        Number of rows.
    duration_s
        Time of the last row from the start.
    signals
        Recorded signals.
    """

    name: str
    file: str
    rows: int
    duration_s: float
    signals: tuple[BenchSignalAnswer, ...]


class ExportAnswer(Answer):
    """Answer of `export`.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    kind
        Language of the files.
    name
        Identifier with which the names of files, types and functions begin.
    verdict
        Verdict of the audit that is run first.
    evidence
        Evidence behind the verdict.
    sample_time_s
        Sample time.
    delay_s
        Time from a sample to its command, as it was verified.
    test_vectors
        Number of test vectors.
    not_covered
        Effects that the verdict does not cover, in sentences.
    exported
        The files.
    """

    schema: int
    version: str
    command: Literal["export"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    kind: str
    name: str
    verdict: Verdict
    evidence: Evidence
    sample_time_s: float
    delay_s: float
    test_vectors: int
    not_covered: tuple[str, ...]
    exported: tuple[ExportedFileAnswer, ...]


class ExportedFileAnswer(Record):
    """A file of the controller.

    Attributes
    ----------
    file
        Name.
    bytes
        Size.
    """

    file: str
    bytes: int


class ReportAnswer(Answer):
    """Answer of `report`.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    summary
        Content of the report in a few numbers.
    figures_
        Names of the figures in the order of the page.
    decision
        Content of the first page.
    """

    schema: int
    version: str
    command: Literal["report"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    summary: tuple[ReportFactAnswer, ...]
    figures_: tuple[str, ...]
    decision: DecisionAnswer


class ReportFactAnswer(Record):
    """Number or finding of a report.

    Attributes
    ----------
    name
        Name of the quantity.
    text
        Value in words, in the display units of the project.
    """

    name: str
    text: str


class DecisionAnswer(Record):
    """Controllers compared with the requirements, and the next steps.

    Attributes
    ----------
    given
        Controller that the project gives, if it gives one.
    designed
        Designed controller, if a design was requested.
    next
        Next steps, a sentence each.
    """

    given: DecidedAnswer | None
    designed: DecidedAnswer | None
    next: tuple[str, ...]


class DecidedAnswer(Record):
    """Results of one controller.

    Attributes
    ----------
    verdict
        Verdict over the family, if an audit was requested.
    specifications
        Verdict on each specification in the order of the file, if there are any.
    proven
        True if the verdict is proven for every plant and every frequency; left out if no proof
        was attempted.
    machine
        Agreement of the nonlinear machine with the verdict, if it was simulated.
    requirements_satisfied
        True if every step on the machine satisfies the requirements in time, if there are any.
    """

    verdict: Verdict | None
    specifications: tuple[Verdict, ...] | None
    proven: bool | None
    machine: Agreement | None
    requirements_satisfied: bool | None


class RefusedAnswer(Answer):
    """Errors of a command that has no answer.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command; null if the command line is invalid.
    project_sha256
        SHA-256 of the bytes of the project file; null if it was not read.
    errors
        Errors, and warnings found with them.
    """

    schema: int
    version: str
    command: str | None
    project_sha256: str | None
    errors: tuple[DiagnosticAnswer, ...]


class DiagnosticAnswer(Record):
    """Error or warning in a file, or of the command line.

    Attributes
    ----------
    severity
        Severity of the finding.
    message
        Sentence on the finding.
    file
        Path of the file; null if no file is concerned.
    line
        Line in the file, from 1; null if none is concerned.
    column
        Column in the line, from 1; null if none is concerned.
    end
        Line and column after the last character of the place; null if none is concerned.
    expected
        Expected value, if it can be named.
    help
        Change that would help, if one is known.
    """

    severity: Severity
    message: str
    file: str | None
    line: int | None
    column: int | None
    end: tuple[int, int] | None
    expected: str | None
    help: str | None


Severity: TypeAlias = Literal["error", "warning"]
"""Severity of a finding."""


class CheckCertificateAnswer(Answer):
    """Answer of `check-certificate`.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project that was proven.
    project_sha256
        SHA-256 of the project file that was proven.
    valid
        True if every claim holds.
    claims
        Claims of the certificate, in words.
    stability_claimed
        True if the certificate claims that every plant is stable.
    differences
        Differences between the certificate and the given project, if there is one.
    not_claimed_in_time
        Numbers of the specifications with a requirement in time, about which nothing is
        claimed.
    rejected_claim
        Number of the claim that is rejected, from 1.
    reason
        Reason for which it is rejected.
    """

    schema: int
    version: str
    command: Literal["check-certificate"]
    title: str
    project_sha256: str
    valid: bool
    claims: tuple[str, ...]
    stability_claimed: bool
    differences: tuple[str, ...] | None
    not_claimed_in_time: tuple[int, ...]
    rejected_claim: int | None
    reason: str | None


class IdentifiedValveAnswer(Answer):
    """Valve identified from recorded static tests.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    project_sha256
        SHA-256 of the bytes of the project file; null without a project.
    tests
        Recorded tests in the order of the files.
    warnings
        Findings in the files, and signals that the identified valve does not explain.
    flow_coefficients
        Flow coefficient K_v of each edge, m3/(s.Pa^0.5).
    leakage_coefficients
        Leakage coefficient K_vin of each edge at null, m3/(s.Pa^0.5).
    leakage_shape
        Shape lambda of the leakage, which is in proportion to sech(lambda U/U_n); of the edge
        from the supply to A if each edge has its own.
    tare_flow_m3_per_s
        Flow of the pilot stage from supply to tank, at `tare_pressure_pa`.
    tare_pressure_pa
        Pressure drop from supply to tank at which the tare flow is stated.
    oil_temperature
        Temperature of the oil in the tests; null if none recorded it.
    null_bias_v
        Spool position at which the valve is at null.
    hysteresis_v
        Width of the hysteresis over a slow full cycle of the command.
    leakage_model
        Model of the leakage for which the values are stated.
    leakage_models
        Fits with both models of the leakage, the better one first.
    leakage_models_difference
        Criterion of the worse model of the leakage less that of the better one.
    leakage_model_preferred
        Better model of the leakage; null if the difference is not decisive.
    lap
        Lap of the edges over full travel, negative for an underlap; null if the identified
        valve has none.
    saturation
        Saturation c of the opening u/(1 + c u) beyond the lap; null if the opening of the
        identified valve is in proportion to u.
    leakage_shapes
        Shape lambda of the leakage of each edge; null if one shape applies to all.
    terms
        Evidence for each term that a valve may have in addition.
    bootstrap
        Extent of the bootstrap; null if none was requested.
    first_guess
        Coefficients at which the search began.
    cost
        Sum of the losses of all residuals over their scales, which the search minimised.
    residual_rms
        Root mean square of all residuals, each over the range of its signal.
    signals
        Fit of each recorded signal.
    misfits
        Signals that the identified valve does not explain, the greatest misfit first.
    correlations
        Pairs of estimates that are correlated by more than 0.9, the closest first.
    not_identifiable
        Combinations of coefficients that the recordings do not determine, the least known
        first.
    joint_region
        Family of valves that the recordings allow; null without the project of a rig.
    simple_calculations
        Values that are read from the curves by the equations of the thesis, section 5.2.
    starts
        Number of starting points of the search, the first guess included.
    starts_that_agree
        Number of starting points that lead to the best minimum.
    converged
        True if no further step of the search explains more.
    at_bounds
        Coefficients that ended at a bound of the search.
    """

    schema: int
    version: str
    command: Literal["identify"]
    project_sha256: str | None
    tests: tuple[ValveTestAnswer, ...]
    warnings: tuple[FileWarningAnswer, ...]
    flow_coefficients: ValveEdgesAnswer
    leakage_coefficients: ValveEdgesAnswer
    leakage_shape: ValveEstimateAnswer
    tare_flow_m3_per_s: ValveEstimateAnswer
    tare_pressure_pa: float
    oil_temperature: TestOilAnswer | None
    null_bias_v: ValveEstimateAnswer
    hysteresis_v: ValveEstimateAnswer
    leakage_model: LeakageModel
    leakage_models: tuple[LeakageFitAnswer, LeakageFitAnswer]
    leakage_models_difference: float
    leakage_model_preferred: LeakageModel | None
    lap: ValveLapAnswer | None
    saturation: ValveEstimateAnswer | None
    leakage_shapes: ValveEdgesAnswer | None
    terms: tuple[ValveTermAnswer, ...]
    bootstrap: BootstrapAnswer | None
    first_guess: CoefficientValuesAnswer
    cost: float
    residual_rms: float
    signals: tuple[ValveSignalAnswer, ...]
    misfits: tuple[ValveMisfitAnswer, ...]
    correlations: tuple[CorrelationAnswer, ...]
    not_identifiable: tuple[NotIdentifiableAnswer, ...]
    joint_region: JointRegionAnswer | None
    simple_calculations: GraphReadingsAnswer
    starts: int
    starts_that_agree: int
    converged: bool
    at_bounds: tuple[str, ...]


class ValveTestAnswer(Record):
    """Recorded test as it was read.

    Attributes
    ----------
    file
        Path of the file.
    test
        Test as the project declares it, if so.
    ports
        Piping of the ports.
    rows
        Number of rows that are used.
    rows_left_out
        Number of rows that are omitted, each with a warning.
    memory_at_start_v
        Lag of the spool at the first row from earlier cycles; zero if the rows do not show one.
    columns
        Columns that are used.
    unused_columns
        Headings of columns that are not used.
    """

    file: str
    test: StaticTest | None
    ports: PortCircuit
    rows: int
    rows_left_out: int
    memory_at_start_v: float
    columns: tuple[ColumnAnswer, ...]
    unused_columns: tuple[str, ...]


StaticTest: TypeAlias = Literal["leakage", "metering", "pressure_gain"]
"""Static test of a servovalve by ISO 10770-1."""


PortCircuit: TypeAlias = Literal["blocked", "connected"]
"""Piping of the ports of a valve: blocked, or connected through a meter."""


class ColumnAnswer(Record):
    """Column of a recorded test that is used.

    Attributes
    ----------
    heading
        Heading of the column.
    signal
        Signal of the column.
    read_in
        Unit in which the column was read.
    reversed
        True if the sign of the column was reversed; only then present.
    unit
        Unit of `range`.
    range
        Least and greatest value of the rows that are used; inf and -inf if none has a value.
    gaps
        Number of rows without a value.
    """

    heading: str
    signal: TestSignal
    read_in: str
    reversed: bool | None
    unit: str
    range: Interval
    gaps: int


TestSignal: TypeAlias = Literal["time", "command", "supply_pressure", "tank_pressure", "pressure_a", "pressure_b", "leak_flow", "flow", "oil_temperature"]
"""Signal of a recorded static test."""


class FileWarningAnswer(Record):
    """Warning on a recorded file.

    Attributes
    ----------
    message
        Sentence on the finding.
    file
        Path of the file.
    line
        Line of the file, from 1, if one is concerned.
    column
        Column of the line, from 1, if one is concerned.
    """

    message: str
    file: str
    line: int | None
    column: int | None


class ValveEdgesAnswer(Record):
    """Value for each of the four edges of a valve.

    Attributes
    ----------
    supply_to_a
        Edge 3, from the supply to port A.
    a_to_tank
        Edge 4, from port A to the tank.
    supply_to_b
        Edge 5, from the supply to port B.
    b_to_tank
        Edge 6, from port B to the tank.
    """

    supply_to_a: ValveEstimateAnswer
    a_to_tank: ValveEstimateAnswer
    supply_to_b: ValveEstimateAnswer
    b_to_tank: ValveEstimateAnswer


class ValveEstimateAnswer(Record):
    """Coefficient of a valve with its confidence interval.

    Attributes
    ----------
    value
        Value at the minimum of the search.
    confidence_95
        Confidence interval of 95 % by linearisation, from low to high; null if the recordings
        do not determine the value.
    bootstrap_95
        Confidence interval of 95 % by the bootstrap, if one was requested, at least one of its
        repetitions converged and the recordings determine the value.
    reason
        Reason for which there is no interval.
    """

    value: float
    confidence_95: Interval | None
    bootstrap_95: Interval | None
    reason: str | None


class TestOilAnswer(Record):
    """Temperature of the oil during the tests, and its effect.

    Attributes
    ----------
    stated_at_degc
        Temperature for which the coefficients are stated.
    recorded_degc
        Lowest and highest temperature of all recordings.
    viscosity_slope_per_degc
        Relative decrease of the dynamic viscosity per degree.
    density_slope_per_degc
        Relative decrease of the density per degree.
    """

    stated_at_degc: float
    recorded_degc: Interval
    viscosity_slope_per_degc: float
    density_slope_per_degc: float


LeakageModel: TypeAlias = Literal["each_edge", "one_curve"]
"""Dependence of the leakage on the spool position."""


class LeakageFitAnswer(Record):
    """Fit with one model of the leakage.

    Attributes
    ----------
    model
        Model of the leakage.
    criterion
        Information criterion of Schwarz: the lower, the better; its zero has no meaning.
    residual_rms
        Root mean square of all residuals, each over the range of its signal.
    coefficients
        Coefficients of the fit.
    """

    model: LeakageModel
    criterion: float
    residual_rms: float
    coefficients: CoefficientValuesAnswer


class CoefficientValuesAnswer(Record):
    """Coefficients of a valve by their names in the table `[valve]`, in SI.

    Attributes
    ----------
    flow_coefficients_supply_to_a
        Value of `valve.flow_coefficients.supply_to_a` in m3/(s.Pa^0.5).
    flow_coefficients_a_to_tank
        Value of `valve.flow_coefficients.a_to_tank` in m3/(s.Pa^0.5).
    flow_coefficients_supply_to_b
        Value of `valve.flow_coefficients.supply_to_b` in m3/(s.Pa^0.5).
    flow_coefficients_b_to_tank
        Value of `valve.flow_coefficients.b_to_tank` in m3/(s.Pa^0.5).
    leakage_coefficients_supply_to_a
        Value of `valve.leakage_coefficients.supply_to_a` in m3/(s.Pa^0.5).
    leakage_coefficients_a_to_tank
        Value of `valve.leakage_coefficients.a_to_tank` in m3/(s.Pa^0.5).
    leakage_coefficients_supply_to_b
        Value of `valve.leakage_coefficients.supply_to_b` in m3/(s.Pa^0.5).
    leakage_coefficients_b_to_tank
        Value of `valve.leakage_coefficients.b_to_tank` in m3/(s.Pa^0.5).
    leakage_shape
        Value of `valve.leakage_shape`, dimensionless.
    tare_flow
        Value of `valve.tare_flow` in m3/s.
    null_bias
        Value of `valve.null_bias` in V.
    hysteresis
        Value of `valve.hysteresis` in V.
    lap_positive
        Value of `valve.lap.positive`, dimensionless.
    lap_negative
        Value of `valve.lap.negative`, dimensionless.
    saturation
        Value of `valve.saturation`, dimensionless.
    leakage_shapes_a_to_tank
        Value of `valve.leakage_shapes.a_to_tank`, dimensionless.
    leakage_shapes_supply_to_b
        Value of `valve.leakage_shapes.supply_to_b`, dimensionless.
    leakage_shapes_b_to_tank
        Value of `valve.leakage_shapes.b_to_tank`, dimensionless.
    """

    flow_coefficients_supply_to_a: float | None
    flow_coefficients_a_to_tank: float | None
    flow_coefficients_supply_to_b: float | None
    flow_coefficients_b_to_tank: float | None
    leakage_coefficients_supply_to_a: float | None
    leakage_coefficients_a_to_tank: float | None
    leakage_coefficients_supply_to_b: float | None
    leakage_coefficients_b_to_tank: float | None
    leakage_shape: float | None
    tare_flow: float | None
    null_bias: float | None
    hysteresis: float | None
    lap_positive: float | None
    lap_negative: float | None
    saturation: float | None
    leakage_shapes_a_to_tank: float | None
    leakage_shapes_supply_to_b: float | None
    leakage_shapes_b_to_tank: float | None


class ValveLapAnswer(Record):
    """Lap of both pairs of edges, over full travel.

    Attributes
    ----------
    positive
        Lap of the edges that a positive command opens.
    negative
        Lap of the edges that a negative command opens.
    """

    positive: ValveEstimateAnswer
    negative: ValveEstimateAnswer


class ValveTermAnswer(Record):
    """Evidence for a term of the valve.

    Attributes
    ----------
    term
        Term in addition to edges that open in proportion and leak in one shape.
    criterion_gain
        Decrease of the information criterion by the term; negative if the term does not explain
        enough for its coefficients.
    taken
        True if the valve is identified with the term.
    """

    term: ValveTerm
    criterion_gain: float
    taken: bool


ValveTerm: TypeAlias = Literal["lap", "saturation", "leakage_by_edge"]
"""Term that a valve may have in addition to edges that open in proportion and leak in one shape."""


class BootstrapAnswer(Record):
    """Extent of a bootstrap of the estimates.

    Attributes
    ----------
    repetitions
        Number of repetitions.
    failed
        Number of repetitions that did not converge and are left out.
    block_rows
        Rows of a block of residuals that change sign together.
    """

    repetitions: int
    failed: int
    block_rows: int


class ValveSignalAnswer(Record):
    """Residuals of a recorded signal.

    Attributes
    ----------
    file
        Path of the recording.
    signal
        Explained signal.
    unit
        SI unit of `rms`, `rms_by_hand`, `scale` and `range`.
    rows
        Number of rows that count.
    rms
        Root mean square of the residuals.
    rms_by_hand
        Root mean square of the residuals with the coefficients that are calculated by hand.
    scale
        Scale of the residuals that a few outliers do not change.
    range
        Largest less smallest recorded value.
    neighbour_correlation
        Correlation of neighbouring residuals: near zero for noise, near one where the model is
        wrong.
    """

    file: str
    signal: SignalKind
    unit: str
    rows: int
    rms: float
    rms_by_hand: float
    scale: float
    range: float
    neighbour_correlation: float


SignalKind: TypeAlias = Literal["pressure_a", "pressure_b", "mean_pressure", "leak_flow", "flow"]
"""Recorded signal that a model of the valve explains."""


class ValveMisfitAnswer(Record):
    """Signal that the identified valve does not explain.

    Attributes
    ----------
    file
        Path of the recording.
    signal
        Signal with the misfit.
    fraction
        Root mean square of the misfit over the range of the signal.
    neighbour_correlation
        Correlation of neighbouring residuals.
    greatest
        Place of the greatest misfit, if a row shows it.
    """

    file: str
    signal: SignalKind
    fraction: float
    neighbour_correlation: float
    greatest: MisfitPlaceAnswer | None


class MisfitPlaceAnswer(Record):
    """Part of a test in which a misfit is greatest.

    Attributes
    ----------
    command_rises
        True while the command rises, false while it falls.
    command_v
        Range of the command, from low to high.
    mean_fraction
        Mean of the modelled less the recorded signal, over the range of the signal.
    """

    command_rises: bool
    command_v: Interval
    mean_fraction: float


class CorrelationAnswer(Record):
    """Correlation of two estimates.

    Attributes
    ----------
    coefficients
        Names of both coefficients in the table `[valve]`.
    correlation
        Correlation, from -1 to 1.
    """

    coefficients: tuple[str, str]
    correlation: float


class NotIdentifiableAnswer(Record):
    """Combination of coefficients that the recordings do not determine.

    Attributes
    ----------
    coefficients
        Names of the coefficients in the table `[valve]`, the greatest component first.
    components
        Components of the direction of length one in the logarithms of the coefficients, in the
        same order.
    standard_deviation
        Standard deviation along the direction, in the logarithm; inf if no recorded signal
        depends on it.
    identifiable_by
        Tests that would determine the combination.
    """

    coefficients: tuple[str, ...]
    components: tuple[float, ...]
    standard_deviation: float
    identifiable_by: tuple[StaticTest, ...]


class JointRegionAnswer(Record):
    """Family of valves that the recordings allow, as independent directions of the uncertainty.

    Attributes
    ----------
    coverage
        Probability that the family contains the valve, from 0 to 1.
    deviations
        Standard deviations to either side of each direction; null without a region.
    directions
        Directions of the family, the one with the greatest effect first.
    left_out
        Number of directions that are omitted because their effect is small; null without a
        region.
    effect_left_out
        Largest relative change of K_qU or K_c from the omitted directions together; null
        without a region.
    reason
        Reason for which there is no region.
    """

    coverage: float
    deviations: float | None
    directions: tuple[RegionDirectionAnswer, ...]
    left_out: int | None
    effect_left_out: float | None
    reason: str | None


class RegionDirectionAnswer(Record):
    """Direction of the uncertainty of an identified valve.

    Attributes
    ----------
    name
        Name of the direction.
    effect
        Largest relative change of K_qU and K_c from the middle of the direction to an end.
    changes
        Change of each value of the project per standard deviation, in SI, by the path of its
        key.
    """

    name: str
    effect: float
    changes: Mapping[str, float]


class GraphReadingsAnswer(Record):
    """Values read from the recorded curves by the equations of the thesis, section 5.2; null without the test for it.

    Attributes
    ----------
    flow_coefficient_extending
        Flow coefficient K_vp for positive commands, which extend, m3/(s.Pa^0.5).
    flow_coefficient_retracting
        Flow coefficient K_vp for negative commands, which retract, m3/(s.Pa^0.5).
    fraction_of_nominal_flow
        Flow of the valve over the rated flow, at the rated pressure drop.
    leakage_coefficient
        Leakage coefficient K_vinp, m3/(s.Pa^0.5).
    null_leakage_m3_per_s
        Leakage at null, above the tare flow.
    leakage_shape
        Shape lambda of the leakage, from the width of its curve at half height.
    tare_flow_m3_per_s
        Flow of the pilot stage, from the base of the leakage curve.
    leakage_pressure_pa
        Pressure drop from supply to tank at which leakage and tare flow are read.
    tare_fraction
        Tare flow over the whole leakage at null.
    null_bias_v
        Mean of the nulls with a rising and a falling command.
    null_rising_v
        Command at null while the command rises.
    null_falling_v
        Command at null while the command falls.
    null_methods
        Features that show null while the command rises and while it falls.
    hysteresis_v
        Null with a rising command less that with a falling one.
    flow_gain_extending_m3_per_s_v
        Flow gain K_qU near null for positive commands.
    flow_gain_retracting_m3_per_s_v
        Flow gain K_qU near null for negative commands.
    flow_gain_commands_v
        Commands from null, to either side, between which the flow gains are read.
    flow_gain_pressure_pa
        Pressure drop from supply to tank at which the flow gains are stated.
    pressure_sensitivity_pa_per_v
        Pressure sensitivity K_pU with blocked ports: slope of p_A - p_B over the command.
    flow_pressure_coefficient
        Flow-pressure coefficient K_c at null, m3/(s.Pa); null also for edges with a lap, whose
        flow gain at null is not the one that is read.
    confidence_95
        Confidence intervals of 95 % of the values that have one.
    """

    flow_coefficient_extending: float | None
    flow_coefficient_retracting: float | None
    fraction_of_nominal_flow: float | None
    leakage_coefficient: float | None
    null_leakage_m3_per_s: float | None
    leakage_shape: float | None
    tare_flow_m3_per_s: float | None
    leakage_pressure_pa: float | None
    tare_fraction: float | None
    null_bias_v: float | None
    null_rising_v: float | None
    null_falling_v: float | None
    null_methods: tuple[NullMethod | None, NullMethod | None]
    hysteresis_v: float | None
    flow_gain_extending_m3_per_s_v: float | None
    flow_gain_retracting_m3_per_s_v: float | None
    flow_gain_commands_v: tuple[float, float] | None
    flow_gain_pressure_pa: float | None
    pressure_sensitivity_pa_per_v: float | None
    flow_pressure_coefficient: float | None
    confidence_95: GraphIntervalsAnswer


NullMethod: TypeAlias = Literal["leakage_centre", "flow_lines", "equal_pressures"]
"""Feature of the recorded curves that shows null."""


class GraphIntervalsAnswer(Record):
    """Confidence intervals of 95 % of values read from curves, each from low to high, in the order of the alphabet.

    Attributes
    ----------
    flow_coefficient_extending
        Confidence interval of `flow_coefficient_extending`.
    flow_coefficient_retracting
        Confidence interval of `flow_coefficient_retracting`.
    flow_gain_extending_m3_per_s_v
        Confidence interval of `flow_gain_extending_m3_per_s_v`.
    flow_gain_retracting_m3_per_s_v
        Confidence interval of `flow_gain_retracting_m3_per_s_v`.
    flow_pressure_coefficient
        Confidence interval of `flow_pressure_coefficient`.
    hysteresis_v
        Confidence interval of `hysteresis_v`.
    leakage_coefficient
        Confidence interval of `leakage_coefficient`.
    null_bias_v
        Confidence interval of `null_bias_v`.
    null_falling_v
        Confidence interval of `null_falling_v`.
    null_leakage_m3_per_s
        Confidence interval of `null_leakage_m3_per_s`.
    null_rising_v
        Confidence interval of `null_rising_v`.
    pressure_sensitivity_pa_per_v
        Confidence interval of `pressure_sensitivity_pa_per_v`.
    fraction_of_nominal_flow
        Confidence interval of `fraction_of_nominal_flow`.
    tare_flow_m3_per_s
        Confidence interval of `tare_flow_m3_per_s`.
    tare_fraction
        Confidence interval of `tare_fraction`.
    """

    flow_coefficient_extending: Interval | None
    flow_coefficient_retracting: Interval | None
    flow_gain_extending_m3_per_s_v: Interval | None
    flow_gain_retracting_m3_per_s_v: Interval | None
    flow_pressure_coefficient: Interval | None
    hysteresis_v: Interval | None
    leakage_coefficient: Interval | None
    null_bias_v: Interval | None
    null_falling_v: Interval | None
    null_leakage_m3_per_s: Interval | None
    null_rising_v: Interval | None
    pressure_sensitivity_pa_per_v: Interval | None
    fraction_of_nominal_flow: Interval | None
    tare_flow_m3_per_s: Interval | None
    tare_fraction: Interval | None


class IdentifiedResponsesAnswer(Answer):
    """Frequency responses identified from recorded signals.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    project_sha256
        SHA-256 of the bytes of the project file; null without a project.
    response
        Responses, and comparisons of them.
    """

    schema: int
    version: str
    command: Literal["identify"]
    project_sha256: str | None
    response: RecordedResponsesAnswer


class RecordedResponsesAnswer(Record):
    """Responses of all records, and comparisons of those at one operating point.

    Attributes
    ----------
    members
        Response of each record, which is a member of a measured family.
    comparisons
        Comparisons of each two records at one operating point, if there are any.
    """

    members: tuple[ResponseMemberAnswer, ...]
    comparisons: tuple[LevelComparisonAnswer, ...] | None


class ResponseMemberAnswer(Record):
    """Frequency response from one record.

    Attributes
    ----------
    file
        Path of the record.
    input
        Name of the column of the input.
    output
        Name of the column of the output.
    unit
        SI unit of the response, output over input.
    rows
        Number of rows of the record.
    time_step_s
        Time between two rows.
    operating_point
        Operating point of the test, if the project names it.
    input_rms
        Root mean square of the input around its mean, in SI.
    method
        Averaging of the record.
    reference
        Name of the column of the signal that moves a closed loop, if the record has one.
    controller
        Controller from which the reference of a closed loop is calculated, if so.
    block_s
        Length of a block: a period, a segment, or the record.
    blocks
        Number of blocks.
    independent_blocks
        Number of independent blocks with the same scatter.
    least_coherence
        Squared coherence below which a frequency is omitted.
    frequencies
        Response at each frequency, the lowest first.
    rows_left_out
        Excited frequencies that are omitted, the lowest first.
    lines_not_excited
        Number of frequencies that the input does not excite.
    distortion
        Distortion of the output, only of a periodic input.
    resampled
        Resampling, only of rows that are not even.
    linear_plant
        Comparison with the linear plant of the project, if it has one of these signals.
    warnings
        Sentences on findings, if there are any.
    """

    file: str
    input: str
    output: str
    unit: str
    rows: int
    time_step_s: float
    operating_point: str | None
    input_rms: float
    method: Averaging
    reference: str | None
    controller: TestControllerSource | None
    block_s: float
    blocks: int
    independent_blocks: float
    least_coherence: float
    frequencies: tuple[ResponsePointAnswer, ...]
    rows_left_out: tuple[OmittedFrequencyAnswer, ...]
    lines_not_excited: int
    distortion: DistortionAnswer | None
    resampled: ResampledAnswer | None
    linear_plant: PlantAgreementAnswer | None
    warnings: tuple[str, ...] | None


Averaging: TypeAlias = Literal["periods", "local_polynomials", "segments"]
"""Averaging of a record: over periods, by local polynomials in frequency, or over segments."""


TestControllerSource: TypeAlias = Literal["declared"]
"""Origin of the controller of a recorded loop."""


class ResponsePointAnswer(Record):
    """Response at one frequency.

    Attributes
    ----------
    frequency_rad_per_s
        Frequency.
    magnitude_db
        Magnitude over that of 1 in the unit of the response.
    phase_deg
        Phase, from -180 to 180.
    coherence
        Squared coherence, from 0 to 1.
    standard_deviation
        Standard deviation of the complex response, in its unit.
    confidence_95
        Radius of the disc around the response that contains the true one with 95 %, in its
        unit.
    relative_confidence_95
        Radius of the disc over the magnitude of the response.
    """

    frequency_rad_per_s: float
    magnitude_db: float
    phase_deg: float
    coherence: float
    standard_deviation: float
    confidence_95: float
    relative_confidence_95: float


class OmittedFrequencyAnswer(Record):
    """Frequency without a usable response.

    Attributes
    ----------
    frequency_rad_per_s
        Frequency.
    coherence
        Squared coherence, from 0 to 1.
    reason
        Reason for which it is omitted.
    """

    frequency_rad_per_s: float
    coherence: float
    reason: Unusable


Unusable: TypeAlias = Literal["the input does not excite this frequency", "the coherence is below the threshold"]
"""Reason for which a frequency is omitted."""


class DistortionAnswer(Record):
    """Size of the output at frequencies that a periodic input does not excite, over that at excited ones; 0 if it is no more than noise.

    Attributes
    ----------
    even
        Distortion at even multiples of the frequency of the period.
    odd
        Distortion at odd multiples.
    """

    even: float
    odd: float


class ResampledAnswer(Record):
    """Resampling of rows at uneven times.

    Attributes
    ----------
    scatter_s
        Time between the earliest and the latest row, each relative to even ones.
    longest_gap_s
        Longest time from one row to the next.
    highest_frequency_rad_per_s
        Highest frequency that straight lines between the rows follow within 5 %.
    """

    scatter_s: float
    longest_gap_s: float
    highest_frequency_rad_per_s: float


class PlantAgreementAnswer(Record):
    """Agreement of a response with the linear plant of the project.

    Attributes
    ----------
    within_confidence_95
        Number of frequencies at which the plant is inside the disc of 95 %.
    largest_difference_db
        Largest magnitude of the ratio of response to plant.
    """

    within_confidence_95: int
    largest_difference_db: float


class LevelComparisonAnswer(Record):
    """Comparison of two records at one operating point.

    Attributes
    ----------
    operating_point
        Name of the operating point.
    files
        Paths of both records, that of the smaller input first.
    input_rms
        Root mean squares of both inputs around their means, in SI.
    false_alarm_probability
        Probability that responses of one linear plant are reported as different, over all
        comparisons of the operating point.
    differences
        Number of frequencies at which the responses differ by more than noise explains.
    frequencies
        Comparison at each common frequency, the lowest first.
    sentence
        Result of the comparison in sentences.
    """

    operating_point: str
    files: tuple[str, str]
    input_rms: tuple[float, float]
    false_alarm_probability: float
    differences: int
    frequencies: tuple[LevelDifferenceAnswer, ...]
    sentence: str


class LevelDifferenceAnswer(Record):
    """Comparison of two responses at one frequency.

    Attributes
    ----------
    frequency_rad_per_s
        Frequency.
    difference_db
        Magnitude of the response at the larger input over that at the smaller one.
    difference_deg
        Phase of the response at the larger input less that at the smaller one, from -180 to
        180.
    distance
        Distance between the complex responses, in their unit.
    explained_by_noise
        Distance that noise explains, in the unit of the responses.
    relative_distance
        The distance over the magnitude of the response at the smaller input.
    relative_explained_by_noise
        The distance that noise explains over the same magnitude.
    exceeds_noise
        True if the distance is larger than noise explains.
    """

    frequency_rad_per_s: float
    difference_db: float
    difference_deg: float
    distance: float
    explained_by_noise: float
    relative_distance: float
    relative_explained_by_noise: float
    exceeds_noise: bool


class IdentifiedFrictionAnswer(Answer):
    """Friction of a cylinder identified from recorded runs.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    title
        Title of the project.
    project_sha256
        SHA-256 of the bytes of the project file, before settings.
    settings
        Settings that replaced values of the file, each `path=value`.
    catalogue_files
        Catalogue files in addition to the built-in catalogue.
    motion
        Motion of the actuator, only of a rig with a motor: its torques are in N m, its angles
        in rad, and the names of such quantities end in those units.
    identified
        Values identified from recordings, which replace those of the file.
    line_model
        Model chosen for the lines, where the file states none.
    friction
        Coefficients of the friction.
    force_zero_n
        Force that the instruments indicate without friction.
    force_zero_n_reason
        Reason for which the value is absent.
    direction_models
        Fits of one friction for both directions and of one for each; empty if they cannot be
        compared, as where the recordings slide in one direction only.
    direction_models_difference
        Decrease of the information criterion by a friction for each direction; null without
        `direction_models`.
    recordings
        Recorded runs.
    force_residual_rms_n
        Root mean square of the residuals of the force, each block of rows as one; null without
        any.
    position_residual_rms_m
        Root mean square of the residuals of the position of pressed or shaken pistons; null
        without any.
    misfits
        Misfits that are not noise, the greatest first.
    warnings
        Misfits in sentences.
    independent_fraction
        Fraction of the residuals that are independent, the least of all signals.
    converged
        True if no further step of the search explains more.
    """

    schema: int
    version: str
    command: Literal["identify"]
    title: str
    project_sha256: str
    settings: tuple[str, ...]
    catalogue_files: tuple[str, ...]
    motion: TurningMotion | None
    identified: RecordedAnswer | None
    line_model: ChosenLinesAnswer | None
    friction: FrictionCoefficientsAnswer
    force_zero_n: FrictionEstimateAnswer | None
    force_zero_n_reason: str | None
    direction_models: tuple[DirectionFitAnswer, ...]
    direction_models_difference: float | None
    recordings: tuple[FrictionRunAnswer, ...]
    force_residual_rms_n: float | None
    position_residual_rms_m: float | None
    misfits: tuple[FrictionMisfitAnswer, ...]
    warnings: tuple[FileWarningAnswer, ...]
    independent_fraction: float
    converged: bool


class FrictionCoefficientsAnswer(Record):
    """Coefficients of the LuGre friction; where friction differs by direction, those of extending.

    Attributes
    ----------
    coulomb_n
        Coulomb friction.
    static_n
        Static friction.
    stribeck_velocity_m_per_s
        Stribeck velocity.
    stribeck_exponent
        Exponent of the fall from static to Coulomb friction.
    viscous_n_s_per_m
        Viscous friction.
    bristle_stiffness_n_per_m
        Stiffness of the bristles.
    bristle_damping_n_s_per_m
        Damping of the bristles.
    retracting
        Friction while the rod retracts; null if it is the same both ways.
    """

    coulomb_n: FrictionEstimateAnswer
    static_n: FrictionEstimateAnswer
    stribeck_velocity_m_per_s: FrictionEstimateAnswer
    stribeck_exponent: FrictionEstimateAnswer
    viscous_n_s_per_m: FrictionEstimateAnswer
    bristle_stiffness_n_per_m: FrictionEstimateAnswer
    bristle_damping_n_s_per_m: FrictionEstimateAnswer
    retracting: RetractingFrictionAnswer | None


class FrictionEstimateAnswer(Record):
    """Coefficient of the friction with its confidence interval.

    Attributes
    ----------
    value
        Estimate; null if the recordings do not determine it.
    confidence_95
        Interval of 95 % that the recordings leave, from low to high.
    reason
        Reason for which there is no estimate; null if there is one.
    """

    value: float | None
    confidence_95: Interval
    reason: str | None


class RetractingFrictionAnswer(Record):
    """Friction while the rod retracts.

    Attributes
    ----------
    coulomb_n
        Coulomb friction.
    static_n
        Static friction.
    viscous_n_s_per_m
        Viscous friction.
    """

    coulomb_n: FrictionEstimateAnswer
    static_n: FrictionEstimateAnswer
    viscous_n_s_per_m: FrictionEstimateAnswer


class DirectionFitAnswer(Record):
    """Fit of one friction for both directions, or of one for each.

    Attributes
    ----------
    model
        Model of the directions.
    criterion
        Information criterion of Schwarz: the lower, the better; its zero has no meaning.
    force_zero_n
        Force that the instruments indicate without friction.
    coulomb_n
        Coulomb friction while extending and while retracting.
    static_n
        Static friction while extending and while retracting.
    """

    model: DirectionModel
    criterion: float
    force_zero_n: float
    coulomb_n: tuple[float, float]
    static_n: tuple[float, float]


DirectionModel: TypeAlias = Literal["same_both_ways", "differs_by_direction"]
"""Model of the directions: one friction for both, or one for each."""


class FrictionRunAnswer(Record):
    """Recorded run, and the rows of it that are used.

    Attributes
    ----------
    file
        Path of the file.
    rows
        Number of rows.
    time_step_s
        Time between two rows.
    constant_velocities
        Rows that slide at a constant velocity.
    varying_velocities
        Rows that are omitted because their velocity is constant on average only.
    pressed_rows
        Number of rows in which a piston at rest is pressed, from the first; only of such a run.
    breaks_away
        True if the pressed piston breaks away; only of such a run.
    shaken_hz
        Frequencies of the sines of the force, only of a run that is shaken.
    """

    file: str
    rows: int
    time_step_s: float
    constant_velocities: tuple[ConstantVelocityAnswer, ...]
    varying_velocities: tuple[VaryingVelocityAnswer, ...]
    pressed_rows: int | None
    breaks_away: bool | None
    shaken_hz: tuple[float, ...] | None


class ConstantVelocityAnswer(Record):
    """Rows that slide at a constant velocity.

    Attributes
    ----------
    velocity_m_per_s
        Velocity of the piston, positive while the rod extends.
    force_n
        Friction force there, less `force_zero_n`.
    modelled_force_n
        Friction force of the identified curve there.
    rows
        Number of rows.
    """

    velocity_m_per_s: float
    force_n: float
    modelled_force_n: float
    rows: int


class VaryingVelocityAnswer(Record):
    """Rows whose velocity is constant on average only.

    Attributes
    ----------
    velocity_m_per_s
        Mean velocity of the piston, positive while the rod extends.
    velocity_range_m_per_s
        Least and greatest velocity over the shortest windows that noise allows.
    rows
        Number of rows.
    """

    velocity_m_per_s: float
    velocity_range_m_per_s: Interval
    rows: int


class FrictionMisfitAnswer(Record):
    """Signal that the friction does not explain.

    Attributes
    ----------
    file
        Path of the recording.
    signal
        Signal with the misfit.
    fraction
        Root mean square of the misfit over the range of the signal.
    neighbour_correlation
        Correlation of neighbouring residuals: of both halves of each constant velocity, or of
        rows.
    velocity_m_per_s
        Constant velocity at which the misfit is greatest; null of pressed or shaken rows.
    mean_residual_n
        Modelled less recorded force at that velocity; null of pressed or shaken rows.
    """

    file: str
    signal: FrictionSignal
    fraction: float
    neighbour_correlation: float
    velocity_m_per_s: float | None
    mean_residual_n: float | None


FrictionSignal: TypeAlias = Literal["force", "position"]
"""Signal that friction explains."""


class IdentifiedLineAnswer(Answer):
    """Line identified from recordings with its far end blocked.

    Attributes
    ----------
    schema
        Version of the layout of answers.
    version
        Version of phea.
    command
        Name of the command.
    project_sha256
        SHA-256 of the bytes of the project file.
    line
        Identified line.
    """

    schema: int
    version: str
    command: Literal["identify"]
    project_sha256: str
    line: LineAnswer


class LineAnswer(Record):
    """Numbers of a line, and the tests from which they follow.

    Attributes
    ----------
    effective_bulk_modulus_pa
        Effective bulk modulus at rest.
    dynamic_stiffening
        Dynamic stiffening of the wall of a hose: its stiffness in fast motion over that at
        rest.
    wave_speed_m_per_s
        Speed of a fast pressure wave.
    dynamic_bulk_modulus_pa
        Effective bulk modulus in fast motion.
    relaxation_time_s
        Time in which the pressure relaxes while the volume is held.
    secant_bulk_modulus_pa
        Bulk modulus between both ends of the pressure rise.
    entrained_air
        Volume of free air at atmospheric pressure over that of the mixture.
    density_kg_per_m3
        Density of the oil, from its inertia with the declared length and bore.
    modulus_slope
        Change of the bulk modulus at rest per change of the pressure.
    chamber
        Chamber at the end of the line.
    pressure_pa
        Pressure at which the numbers are stated.
    volume_m3
        Volume of the oil in the line, to which the moduli refer.
    misfits
        Signals that the line does not explain.
    warnings
        Misfits in sentences.
    remark
        Remark on parts that the test omits, if there are any.
    pressure_rise
        Fit of the slow pressure rise; null without one.
    frequency_response
        Fit of the frequency response; null without one.
    """

    effective_bulk_modulus_pa: LineEstimateAnswer
    dynamic_stiffening: LineEstimateAnswer
    wave_speed_m_per_s: LineEstimateAnswer
    dynamic_bulk_modulus_pa: LineEstimateAnswer
    relaxation_time_s: LineEstimateAnswer
    secant_bulk_modulus_pa: LineEstimateAnswer
    entrained_air: LineEstimateAnswer
    density_kg_per_m3: LineEstimateAnswer
    modulus_slope: LineEstimateAnswer
    chamber: LineSide
    pressure_pa: float
    volume_m3: float
    misfits: tuple[LineMisfitAnswer, ...]
    warnings: tuple[FileWarningAnswer, ...]
    remark: str | None
    pressure_rise: PressureRiseAnswer | None
    frequency_response: LineResponseAnswer | None


class LineEstimateAnswer(Record):
    """Number of a line with its confidence interval.

    Attributes
    ----------
    value
        Estimate; null if the recordings do not determine it.
    confidence_95
        Confidence interval of 95 %, from low to high; null without an estimate.
    reason
        Reason for which there is no estimate; null if there is one.
    """

    value: float | None
    confidence_95: Interval | None
    reason: str | None


LineSide: TypeAlias = Literal["a", "b"]
"""Chamber of the cylinder or motor."""


class LineMisfitAnswer(Record):
    """Signal that the line does not explain.

    Attributes
    ----------
    file
        Path of the recording.
    signal
        Signal with the misfit: `volume` of a pressure rise, `response` of a frequency response.
    fraction
        Root mean square of the misfit over the range of the volume, or over the response.
    neighbour_correlation
        Correlation of neighbouring residuals; null of a frequency response.
    """

    file: str
    signal: str
    fraction: float
    neighbour_correlation: float | None


class PressureRiseAnswer(Record):
    """Fit of a slow pressure rise.

    Attributes
    ----------
    file
        Path of the recording.
    rows
        Number of rows.
    volume_from
        Origin of the displaced volume.
    pressures_pa
        Lowest and highest pressure.
    terms
        Number of terms of the volume over the pressure; 1 for a constant compliance, that of
        free air apart.
    compliance
        Compliance at the lowest, the middle and the highest pressure.
    drift_m3_per_s
        Flow that the meter shows, or the line loses, at standstill.
    drift_m3_per_s_reason
        Reason for which the value is absent.
    volume_noise_m3
        Root mean square of the noise of the volume that differs from row to row.
    volume_walk_m3
        Root mean square of the growth, from row to row, of the summed noise of a flow meter.
    """

    file: str
    rows: int
    volume_from: VolumeSource
    pressures_pa: Interval
    terms: int
    compliance: tuple[TangentComplianceAnswer, TangentComplianceAnswer, TangentComplianceAnswer]
    drift_m3_per_s: float | None
    drift_m3_per_s_reason: str | None
    volume_noise_m3: float
    volume_walk_m3: float


VolumeSource: TypeAlias = Literal["flow", "volume", "position"]
"""Origin of a displaced volume: integral of a flow, recorded volume, or position of a piston times its area."""


class TangentComplianceAnswer(Record):
    """Slope of the displaced volume over the pressure.

    Attributes
    ----------
    pressure_pa
        Pressure.
    compliance_m3_per_pa
        Slope of the volume over the pressure.
    standard_deviation
        Standard deviation of the compliance, in its unit.
    """

    pressure_pa: float
    compliance_m3_per_pa: float
    standard_deviation: float


class LineResponseAnswer(Record):
    """Fit of a frequency response, pressure over flow.

    Attributes
    ----------
    file
        Path of the recording.
    rows
        Number of rows.
    pressure_pa
        Mean recorded pressure.
    misfit
        Sum of the squared residuals over that of noise, for each degree of freedom.
    degrees_of_freedom
        Degrees of freedom of the residuals.
    explained
        True if the residuals are no larger than noise makes them.
    compliance
        Compliance at each frequency, the lowest first.
    """

    file: str
    rows: int
    pressure_pa: float
    misfit: float
    degrees_of_freedom: float
    explained: bool
    compliance: tuple[DynamicComplianceAnswer, ...]


class DynamicComplianceAnswer(Record):
    """Compliance at one frequency: imaginary part of flow over pressure, divided by the frequency.

    Attributes
    ----------
    frequency_rad_per_s
        Frequency.
    compliance_m3_per_pa
        Measured compliance.
    confidence_95
        Half of the confidence interval of 95 % of the measured compliance, in its unit.
    model_m3_per_pa
        Compliance of the fitted line; null if its model does not exist.
    coherence
        Squared coherence of the recording, from 0 to 1.
    """

    frequency_rad_per_s: float
    compliance_m3_per_pa: float
    confidence_95: float
    model_m3_per_pa: float | None
    coherence: float
