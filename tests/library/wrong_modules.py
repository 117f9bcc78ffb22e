"""Modules of the project made wrong while a test lasts, in place."""

from __future__ import annotations

import importlib
import inspect
import types


def functions(namespace, module):
    """Those of a module and of its classes, by name."""
    for name, found in namespace.items():
        if inspect.isclass(found) and found.__module__ == module:
            yield from ((f"{name}.{inner}", function)
                        for inner, function in functions(vars(found), module))
        elif isinstance(found, types.FunctionType) and found.__module__ == module:
            yield name, found


def make_wrong(monkeypatch, name, right, wrong):
    """Put ``wrong`` in the place of ``right``, which is in the module once, within its functions:
    whoever uses these, or inherits them, gets the wrong ones."""
    module = importlib.import_module(f"cardcage.{name}")
    source = inspect.getsource(module)
    assert source.count(right) == 1, f"{right!r} is in {name} {source.count(right)} times"
    mutant = types.ModuleType(module.__name__)
    mutant.__package__ = module.__package__
    exec(compile(source.replace(right, wrong), module.__file__, "exec"), mutant.__dict__)
    changed = dict(functions(vars(mutant), module.__name__))
    for place, function in functions(vars(module), module.__name__):
        monkeypatch.setattr(function, "__code__", changed[place].__code__)
