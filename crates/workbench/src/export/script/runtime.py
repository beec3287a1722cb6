

def _whole(value: float) -> float:
    """Nearest whole number, halves away from zero."""
    magnitude = abs(value)
    if magnitude < 2.0**52:
        nearest = float(math.floor(magnitude))
        magnitude = nearest + 1.0 if magnitude - nearest >= 0.5 else nearest
    return math.copysign(magnitude, value)


def _level(value: float, converter: tuple[float, float, float]) -> float:
    """Nearest level of a converter within its range."""
    step, least, greatest = converter
    return min(max(_whole(value / step) * step, least), greatest)


def _settled(
    sections: list[tuple[Any, ...]], signal: float, wanted: float
) -> tuple[list[list[float]], float]:
    """States in which nothing changes, and the output; a section that integrates gives the wanted one."""
    states = []
    for b0, b1, b2, _, a1, a2, gain in sections:
        output = wanted if gain is None else gain * signal
        second = b2 * signal - a2 * output
        states.append([b1 * signal - a1 * output + second, second])
        signal = output
    return states, signal


def _advance(
    section: tuple[Any, ...], state: list[float], signal: float, output: float
) -> None:
    _, b1, b2, _, a1, a2, _ = section
    state[0] = b1 * signal - a1 * output + state[1]
    state[1] = b2 * signal - a2 * output


def _filtered(sections: list[tuple[Any, ...]], states: list[list[float]], signal: float) -> float:
    for section, state in zip(sections, states):
        output = section[0] * signal + state[0]
        _advance(section, state, signal, output)
        signal = output
    return signal


class Controller:
    """The controller as its computer executes it: the bits of the simulation.

    Attributes ``command``, ``unlimited``, ``limited`` and ``invalid`` are the outputs of the last
    sample.
    """

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """State at rest, with a command of zero."""
        self._prefilter, self._feedback, self._inner = (
            [[0.0, 0.0] for _ in sections] for sections in (PREFILTER, FEEDBACK, INNER)
        )
        self.command = self.unlimited = 0.0
        self.limited = self.invalid = False

    def hold(self, command: float, *signals: float) -> None:
        """State at which the signals, in the order of SIGNALS, give a command.

        An integral part then moves on with the error; a controller without one gives its response
        to the error instead. The command is neither limited nor rounded.
        """
        if not all(map(math.isfinite, (command, *signals))):
            return
        reference, measurement, added, pressure = self._read(signals)
        self._prefilter, filtered = _settled(PREFILTER, reference, 0.0)
        held = command
        if INNER:
            self._inner, back = _settled(INNER, pressure, 0.0)
            held = held + back
        if FEED_FORWARD != 0.0:
            held = held - added
        self._feedback, _ = _settled(FEEDBACK, filtered - measurement, held)
        self.command = command

    def step(self, *signals: float) -> float:
        """Command for a sample of the signals, in the order of SIGNALS."""
        self.invalid = not all(map(math.isfinite, signals))
        if self.invalid:
            self.unlimited, self.limited = self.command, False
            return self.command
        reference, measurement, added, pressure = self._read(signals)
        error = _filtered(PREFILTER, self._prefilter, reference) - measurement
        if INNER:
            added = added - _filtered(INNER, self._inner, pressure)
        before = [list(state) for state in self._feedback]
        signal = _filtered(FEEDBACK[:-1], self._feedback, error)
        last, state = FEEDBACK[-1], self._feedback[-1]
        output = last[0] * signal + state[0]
        self.unlimited = output + added
        command = min(max(self.unlimited, -COMMAND_LIMIT), COMMAND_LIMIT)
        self.limited = command != self.unlimited
        continued = output
        if ANTI_WINDUP == "back_calculation" and self.limited:
            continued = command - added
        _advance(last, state, signal, continued)
        if ANTI_WINDUP == "clamping" and self.limited and self.unlimited * error > 0.0:
            self._feedback = before
        self.command = _level(command, COMMAND_CONVERTER) if COMMAND_CONVERTER else command
        return self.command

    @staticmethod
    def _read(signals: tuple[float, ...]) -> tuple[float, float, float, float]:
        """Reference, measurement, part of the command by the feedforward, pressure signal."""
        read = dict(zip(SIGNALS, signals))
        measurement, velocity = read["measurement"], read.get("velocity", 0.0)
        if MEASUREMENT_CONVERTER:
            measurement = _level(measurement, MEASUREMENT_CONVERTER)
        if VELOCITY_RESOLUTION > 0.0:
            velocity = VELOCITY_RESOLUTION * _whole(velocity / VELOCITY_RESOLUTION)
        added = FEED_FORWARD * velocity if FEED_FORWARD != 0.0 else 0.0
        return read["reference"], measurement, added, read.get("pressure", 0.0)


def self_test() -> int:
    """Number of test vectors with an output that differs."""
    controller, differing = Controller(), 0
    for operation, signals, held, command, unlimited, limited, invalid in VECTORS:
        if operation == "reset":
            controller.reset()
        elif operation == "hold":
            controller.hold(held, *signals)
        controller.step(*signals)
        found = (controller.command, controller.unlimited, controller.limited, controller.invalid)
        differing += found != (command, unlimited, limited, invalid)
    return differing


def transfer_function(sections: list[tuple[Any, ...]]) -> Any:
    """Transfer function in z of PREFILTER, FEEDBACK or INNER, for python-control."""
    import control

    product = control.tf([1.0], [1.0], SAMPLE_TIME_S)
    for b0, b1, b2, a0, a1, a2, _ in sections:
        product = product * control.tf([b0, b1, b2], [a0, a1, a2], SAMPLE_TIME_S)
    return product


def response(sections: list[tuple[Any, ...]], frequency: float) -> complex:
    """Response of sections at a frequency in rad/s.

    With d = exp(-i w T) - 1 nothing cancels where w T is small:
    b0 + b1/z + b2/z^2 = (b0 + b1 + b2) + (b1 + 2 b2) d + b2 d^2.
    """
    angle = frequency * SAMPLE_TIME_S
    d = complex(-2.0 * math.sin(angle / 2.0) ** 2, -math.sin(angle))
    product = complex(1.0)
    for b0, b1, b2, a0, a1, a2, _ in sections:
        above = math.fsum((b0, b1, b2)) + d * (b1 + 2.0 * b2 + d * b2)
        below = math.fsum((a0, a1, a2)) + d * (a1 + 2.0 * a2 + d * a2)
        product *= above / below
    return product


def plant(index: int = 0) -> Any:
    """Plant of the family for python-control, without its dead time."""
    import control

    _, zeros, poles, gain, _ = PLANTS[index]
    return control.zpk(zeros, poles, gain)


if __name__ == "__main__":
    print(f"{self_test()} of {len(VECTORS)} test vectors differ")
