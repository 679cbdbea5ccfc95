"""A study on the nodes of a SLURM cluster: python slurm.py PLAN RESULTS, on a login node.

Needs `pip install "rocking-study[cluster]"` on every node and a folder RESULTS that all of them share. Queue, account,
cores, memory and wall time are the cluster's own: they may as well stand in ~/.config/dask/jobqueue.yaml. A job that
ends takes its blocks with it and no others; the same command goes on where the study stopped.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

from dask_jobqueue import SLURMCluster

import rocking

JOBS = int(os.environ.get("JOBS", "4"))
CORES = int(os.environ.get("CORES", "32"))


def main(plan: str, results: str) -> None:
    logs = Path(results).resolve() / "slurm"
    with SLURMCluster(
        cores=CORES,  # of a job
        processes=1,  # the kernels run side by side in the threads of one process
        memory=f"{CORES} GB",
        walltime="01:00:00",
        local_directory=str(logs),
        log_directory=str(logs),
    ) as cluster:
        cluster.scale(jobs=JOBS)
        print(f"waiting for the first of {JOBS} jobs")
        with cluster.get_client() as client:
            client.wait_for_workers(1)
        print(rocking.run(plan, results=results, scheduler=cluster.scheduler_address))


if __name__ == "__main__":
    main(*sys.argv[1:])
