"""A campaign on Dask: random rigs, their results as a table, and what the spread depends on.

Each run draws the parameters of the rig and simulates it. Two worker processes of this computer
compute the runs in chunks; a client of a cluster in their place changes nothing else, nor a byte of
the table. The table grows on disk: after an interruption the same call has the missing runs only.
Needs ``pip install 'phea[dask,pandas]'``; without Dask, the threads of this process compute the
runs. Run it with ``python 03_campaign.py [runs.csv]``.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import phea
import phea.distributed

# Runs of a task: some seconds of work for a campaign that is worth a cluster.
CHUNK = 5


@contextmanager
def dask_client() -> Iterator[Any]:
    """Client of two worker processes, or ``None`` where Dask is not installed."""
    try:
        import distributed
    except ImportError:
        yield None
        return
    dask: Any = distributed  # functions without types
    with (
        dask.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        dask.Client(cluster) as client,  # Client("scheduler:8786") for a cluster of your own
    ):
        yield client


def computed(
    project: phea.Project,
    runs: int,
    out: Path,
    client: Any,
    progress: bool | Callable[[str, float], object] = False,
) -> phea.results.Campaign:
    """The campaign, on the workers of a client or on this computer."""
    if client is None:
        return project.campaign(runs=runs, out=out, threads=1, files=False, progress=progress)
    return phea.distributed.campaign(
        project, runs=runs, out=out, client=client, chunk=CHUNK, progress=progress
    )


def main(out: Path, runs: int = 60) -> None:
    """Writes the table of the runs."""
    project = phea.example("benchmark/campaign")
    with dask_client() as client:
        if client is None:
            print("Dask is not installed: the runs are computed here")
        else:
            workers = client.scheduler_info(n_workers=-1)["workers"]
            print(f"{len(workers)} workers of Dask, with {phea.distributed.identity()}")

        # The first half: as if the work had been interrupted there.
        try:
            computed(project, runs, out, client, progress=lambda stage, fraction: fraction < 0.5)
        except phea.Stopped as stopped:
            print(stopped)
        rows = out.read_bytes().count(b"\n") - 1
        print(f"{rows} of {runs} runs before the interruption")
        assert 0 < rows < runs

        # The same call has the other runs, and the bytes of an uninterrupted campaign here.
        campaign = computed(project, runs, out, client)
        print(campaign.text)
        assert out.read_bytes() == project.campaign(runs=runs, files=False).files["runs.csv"]

        # One command for several values of a key, each value a task.
        if client is not None:
            lengths = ["1.5 m", "3 m"]
            hose = phea.example("ybitu/hose")
            models = phea.distributed.sweep(hose, "line.length", lengths, "linearize", client)
            softest = [one.stiffness.by_volume.low for one in models]
            print(f"least stiffness: {softest[0]:.3g} N/m, of the longer hose {softest[1]:.3g} N/m")
            assert softest[1] < softest[0]

    # The rows as a frame of pandas, with units.
    frame = campaign.to_pandas()
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
