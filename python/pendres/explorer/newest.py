"""Work whose result is wanted only as long as nothing newer was asked for."""
import threading

from .._handles import Context
from .._library import errors, lib

INTERRUPTED = errors[lib.PENDRES_INTERRUPTED]


class Newest:
    """A thread that computes what was asked for last. What it works on meanwhile is stopped as soon
    as something newer is asked for; its results are not shown.

    show(result) and fail(sentence) are called through `deliver`, which takes them to the thread of
    the page. What takes long `wait`s some seconds, so that what is quick has the processor first, or
    rests for some after its first result.
    """

    def __init__(self, deliver, show, fail, wait=0.0, rest=0.0):
        self._deliver, self._show, self._fail = deliver, show, fail
        self._wait, self._rest = wait, rest
        self._wanted = None            # what nobody works on yet
        self._ended = False
        self._change = threading.Condition()
        self._thread = threading.Thread(target=self._work, daemon=True)
        self._thread.start()

    def ask(self, steps):
        """`steps(context)` yields results, each better than the one before."""
        with self._change:
            self._wanted = steps
            self._change.notify()

    def end(self):
        """Stop, for good."""
        with self._change:
            self._ended, self._wanted = True, None
            self._change.notify()

    def _stale(self):
        return self._ended or self._wanted is not None

    def _work(self):
        context = Context(stop=self._stale, threads=2)
        while True:
            with self._change:
                self._change.wait_for(self._stale)
                if self._ended:
                    return
                steps, self._wanted = self._wanted, None
                if self._wait and self._change.wait_for(self._stale, self._wait):
                    continue
            try:
                for number, result in enumerate(steps(context)):
                    if self._stale():
                        break
                    self._deliver(self._show, result)
                    if self._rest and number == 0:
                        with self._change:
                            self._change.wait_for(self._stale, self._rest)
            except INTERRUPTED:
                pass
            except Exception as why:  # pylint: disable=broad-except
                # Whatever it is, it is told on the page: a thread's traceback is seen by nobody.
                if not self._stale():
                    self._deliver(self._fail, f"{why}" or type(why).__name__)
