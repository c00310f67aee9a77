"""The choice of the native module: this package brings one, and a package with plug-ins of its own can bring another.

A crate that `voussoir new crate` writes makes a wheel whose native module contains all of Voussoir and the plug-ins of the
crate. The wheel names the module as an entry point of the group `voussoir.native`.
"""

from __future__ import annotations

import sys
from importlib import import_module
from importlib.metadata import PackageNotFoundError, entry_points, version

_NAME = "voussoir._voussoir"


def choose() -> None:
    """Replaces the native module of this package if another installed package brings one.

    Raises ImportError if several packages bring one, or if it belongs to another version of Voussoir.
    """
    found = sorted({own.value for own in entry_points(group="voussoir.native")})
    if not found:
        return
    if len(found) > 1:
        raise ImportError(
            f"several packages bring plug-ins for Voussoir: {', '.join(found)}. A program contains the plug-ins of one of "
            "them: uninstall the others, or make a crate that depends on all of them"
        )
    module = import_module(found[0])
    try:
        wanted = version("voussoir")
    except PackageNotFoundError:
        wanted = module.__version__
    if module.__version__ != wanted:
        raise ImportError(
            f"{found[0]} was compiled with Voussoir {module.__version__}, but the package voussoir is {wanted}: install the "
            "same version of both"
        )
    sys.modules[_NAME] = module
