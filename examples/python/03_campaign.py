"""A campaign: random rigs, their results as a table, and what the spread depends on.

Each run draws the parameters of the rig and simulates it. The table grows on disk: after Ctrl-C the
same call continues with the runs that are missing. Run it with
``python 03_campaign.py [runs.csv]``.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import phea


def main(out: Path, runs: int = 60) -> None:
    """Writes the table of the runs."""
    project = phea.example("benchmark/campaign")

    # The first half: as if the work had been interrupted there.
    def half(stage: str, fraction: float) -> bool:
        return fraction < 0.5

    try:
        project.campaign(runs=runs, out=out, threads=1, files=False, progress=half)
    except phea.Stopped as stopped:
        print(stopped)
    rows = out.read_bytes().count(b"\n") - 1
    print(f"{rows} of {runs} runs before the interruption")
    assert 0 < rows < runs

    # The same call has the other runs, and the bytes of an uninterrupted campaign.
    campaign = project.campaign(runs=runs, out=out, files=False)
    print(campaign.text)
    assert out.read_bytes() == project.campaign(runs=runs, files=False).files["runs.csv"]

    # The rows as a frame of pandas, with units.
    frame = phea.Table(out.read_bytes()).to_pandas()
    overshoot = frame["event1_overshoot_percent"]
    print(f"overshoot: median {overshoot.median():.3f} {frame.attrs['units'][overshoot.name]}")
    assert len(frame) == runs and frame.attrs["units"]["event1_overshoot_percent"] == "%"

    # Which drawn parameter goes with the overshoot: rank correlation over the runs.
    drawn = [name for name in frame if "." in name and "_at_" not in name]
    ranks = frame[drawn].rank().corrwith(overshoot.rank()).sort_values(key=abs)
    print(f"most influence on the overshoot: {ranks.index[-1]} ({ranks.iloc[-1]:+.2f})")
    assert abs(ranks.iloc[-1]) > 0.3

    # The worst run once more, in full, from its index alone.
    worst = int(frame["run"][overshoot.idxmax()])
    print(project.campaign_run(worst).text)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as temporary:
            main(Path(temporary) / "runs.csv")
