"""The law of another crate in Python: in this process, in results, and in the processes of a pool.

    python law_of_a_crate.py STUDY          with the study that `voussoir new crate` writes for the law `pinned`
"""

import json
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import voussoir


def load_factor(text):
    return voussoir.run(text)[0].load_factor


if __name__ == "__main__":
    text = open(sys.argv[1], encoding="utf-8").read()
    assert "pinned" in voussoir.plugins("laws")
    results = voussoir.run(text)
    assert results[0].certified and abs(results[0].load_factor - 10.0) < 1e-9, results[0].load_factor
    crates = json.loads(results.files["results.json"])["plugins"]
    assert {"crate": "pins", "version": "0.1.0", "tags": ["pinned"]} in crates, crates
    assert voussoir.conform("pinned").passed
    # A new process, as the workers of a Dask cluster are.
    with ProcessPoolExecutor(2, get_context("spawn")) as pool:
        assert list(pool.map(load_factor, [text, text])) == [results[0].load_factor] * 2
    print("the law pinned of the crate pins works in Python")
