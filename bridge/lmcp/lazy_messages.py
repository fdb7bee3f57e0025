"""Messages whose fields are read on first access.

The lazy class of a message class is a subclass with the same slots, all unset, so an access falls through to
`__getattr__`. The leading numbers of a message, which have fixed positions, are read separately, as they are
immutable; an access to any other field reads all of them, and turns the object into an ordinary one by giving it its
real class. A message that is only passed on costs no more than its checksum.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cratous.bridge.lmcp import compiled
from cratous.bridge.lmcp.objects import LmcpObject

AT = 8 + compiled.HEAD_SIZE  # bytes of a message before the fields of its root object
# Methods that look at `type(self)` or write, and so need the real class.
_COMPLETE_FIRST = (
    "__eq__", "__repr__", "__rich_repr__", "__reduce__", "__setattr__", "__delattr__", "copy",
    "checked",
)  # fmt: skip
Fill = Callable[[Any, Any, bytes, str], None]


def class_of(cls: type[LmcpObject], fill: Fill) -> Any:
    """The lazy class of a message class that has fields.

    fill(obj, reader, message, where) reads the fields into the object, or raises BadInput.
    """
    reader, front, in_front, size = compiled.fillers(cls)
    least = AT + size + 4

    def complete(self: Any) -> Any:
        if type(self) is made:
            data, where = self._raw
            object.__setattr__(self, "__class__", cls)
            try:
                fill(self, reader, data, where)
            except BaseException:
                for name in cls.names:  # as if no field had been read
                    if hasattr(self, name):
                        delattr(self, name)
                object.__setattr__(self, "__class__", made)
                raise
            del self._raw
        return self

    def read_front(self: Any) -> bool:
        data = self._raw[0]
        if len(data) < least:
            return False
        object.__setattr__(self, "__class__", cls)
        try:
            front(self, data, AT, 0)
        except compiled.GIVES_UP:
            return False
        finally:
            object.__setattr__(self, "__class__", made)
        return True

    def __getattr__(self: Any, name: str) -> Any:
        if name in in_front and read_front(self):
            return getattr(self, name)
        if name not in cls.names:
            raise AttributeError(f"{cls.__name__!r} object has no attribute {name!r}")
        return getattr(complete(self), name)

    body: dict[str, Any] = {
        "__slots__": (),
        "__module__": cls.__module__,
        "__doc__": cls.__doc__,
        "__hash__": None,
        "real_class": cls,
        "complete": complete,
        "raw_message": lambda self: self._raw[0],
        "__getattr__": __getattr__,
    }
    for method in _COMPLETE_FIRST:
        body[method] = _after(complete, method)
    made: Any = type(cls.__name__, (cls,), body)
    return made


def _after(complete: Callable[[Any], Any], method: str) -> Callable[..., Any]:
    def call(self: Any, *args: Any, **named: Any) -> Any:
        return getattr(complete(self), method)(*args, **named)

    call.__name__ = method
    return call
