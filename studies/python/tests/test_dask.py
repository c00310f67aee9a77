"""Sweeps on a Dask cluster give the same numbers, also if a worker is killed during the sweep."""

import os
import signal

import pytest

import voussoir
from test_voussoir import same, swept

distributed = pytest.importorskip("distributed")


def test_a_killed_worker_loses_nothing():
    study = swept(400)
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster, distributed.Client(cluster) as client:
        killed = []

        def progress(done, of):
            if not killed and done >= 100:
                pid = client.submit(os.getpid, pure=False).result()
                killed.append(pid)
                os.kill(pid, signal.SIGKILL)

        table = voussoir.sweep(study, client=client, chunk=20, progress=progress)
    assert killed and table.count == 800 and list(table["id"]) == list(range(800))
    assert all(table["certified"])
    same(table, voussoir.sweep(study))
