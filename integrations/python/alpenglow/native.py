# SPDX-License-Identifier: MIT
"""Calls of the library: contexts, errors, progress and lifetimes."""
import collections
import logging
import os
import threading

try:
    from ._binding import ffi, lib
except ImportError as error:
    raise ImportError(f"alpenglow: {error}; install the library, then this module again "
                      "(pip install --no-build-isolation .)") from error

_log = logging.getLogger("alpenglow")
_WORDS = {"force it (-f)": "give overwrite=True", "--sky 1,1,1": "sky=1.0"}  # options of the command
_running = threading.local()  # .call: the call that this thread is in


class Error(Exception):
    """A call that failed. The text is the library's message: file, object, fault and remedy.

    code: "INVALID_ARGUMENT", "INVALID_DATA", "UNSUPPORTED", "LIMIT", "IO", "OUT_OF_MEMORY" or
    "CANCELLED".
    """

    def __init__(self, code, message):
        super().__init__(message or code)
        self.code = code


class Cancelled(Error):
    """A progress function returned False; nothing was written."""


Progress = collections.namedtuple("Progress", "stage done total seconds_left")
Progress.__doc__ = """The state of a long call, about 20 times a second.

stage: its name; done, total: units of the stage, such as rays; seconds_left: None while unknown.
"""


class _Call:
    """One call: its progress function, and the exception that ends it."""

    def __init__(self, progress):
        self.progress = progress
        self.error = None

    def goes_on(self, state):
        if self.error is None and self.progress is not None:
            left = state.seconds_left
            seen = Progress(text(state.stage), state.done, state.total, left if left >= 0 else None)
            return self.progress(seen) is not False
        return self.error is None


def _keep_error(_kind, error, _trace):
    _running.call.error = error


# Python handles signals inside these two, so Ctrl-C raises KeyboardInterrupt there.
@ffi.def_extern(error=False, onerror=_keep_error)
def alpenglow_progress(_user, state):
    return _running.call.goes_on(state)


@ffi.def_extern(onerror=_keep_error)
def alpenglow_log(_user, message):
    level = logging.WARNING if message.level == lib.ALP_LOG_WARNING else logging.INFO
    _log.log(level, "%s (%s)", text(message.text), text(message.code))


def text(chars):
    """A string of the library, whatever its bytes are."""
    return ffi.string(chars).decode("utf-8", "replace")


def chars(string):
    """A name or path for the library."""
    encoded = os.fsencode(string)
    if b"\0" in encoded:
        raise ValueError("a name or path holds a null character")
    return ffi.new("char[]", encoded)


class Handle:
    """An object of the library. It is destroyed after its handle and all objects made from it.

    The collector of cycles may finalize a parent first, so uses are counted.
    """

    _lock = threading.RLock()

    def __init__(self, pointer, destroy, *parents):
        self.pointer, self._destroy, self._parents, self._uses = pointer, destroy, parents, 1
        with self._lock:
            for parent in parents:
                parent._uses += 1

    def _release(self):
        with self._lock:
            self._uses -= 1
            unused = self._uses == 0
        if unused:
            self._destroy(self.pointer)
            for parent in self._parents:
                parent._release()

    __del__ = _release


def version():
    """Version of the library, such as "0.1.0"."""
    return text(lib.alp_version())


def as_dict(struct):
    """A struct of the library as a dict of numbers, lists and dicts."""
    def value(kind, of):
        if kind.kind == "struct":
            return as_dict(of)
        return list(of) if kind.kind == "array" else of
    return {name: value(field.type, getattr(struct, name))
            for name, field in ffi.typeof(struct).fields}


class Context:
    """Worker threads, log and error message of the calls that are made with it, one at a time.

    threads: number of workers, 0 for one a core; it changes the time and never a bit of a result.
    read_outside: whether assets may name files outside of their own folder.
    """

    def __init__(self, threads=0, read_outside=False):
        options = lib.alp_context_options_default()
        options.worker_count = threads
        options.read_outside = read_outside
        options.log = lib.alpenglow_log
        out = ffi.new("alp_context **")
        result = lib.alp_context_create(ffi.addressof(options), out)
        if result != lib.ALP_OK:
            raise Error(text(lib.alp_result_name(result)),
                        f"no context with {threads} threads; give 0 to 1024")
        self.handle = Handle(out[0], lib.alp_context_destroy)
        self._lock = threading.Lock()

    @property
    def threads(self):
        """Number of workers, at least 1."""
        return lib.alp_context_worker_count(self.handle.pointer)

    def call(self, function, *arguments, progress=None):
        """Calls a function of the library that may fail. Handles stay alive until it returns."""
        if not self._lock.acquire(blocking=False):
            raise Error("INVALID_ARGUMENT", "the context is in another call; give each thread a "
                                            "Context and scenes of its own")
        before, call = getattr(_running, "call", None), _Call(progress)
        _running.call = call
        try:
            result = function(*[argument.pointer if isinstance(argument, Handle) else argument
                                for argument in arguments])
            self._raise(result, call.error)
        finally:
            _running.call = before
            self._lock.release()

    def make(self, kind, destroy, parents, function, *arguments, progress=None):
        """Calls a function that sets its argument `...` to a new object. Returns the Handle."""
        out = ffi.new(kind + " **")
        arguments = [out if argument is ... else argument for argument in arguments]
        try:
            self.call(function, *arguments, progress=progress)
        finally:
            if out[0] != ffi.NULL:
                made = Handle(out[0], destroy, self.handle, *parents)
        return made

    def _raise(self, result, error):
        if error is not None:
            raise error
        if result != lib.ALP_OK:
            code = text(lib.alp_result_name(result))
            kind = Cancelled if code == "CANCELLED" else Error
            message = text(lib.alp_context_message(self.handle.pointer))
            for option, keyword in _WORDS.items():
                message = message.replace(option, keyword)
            raise kind(code, message)
