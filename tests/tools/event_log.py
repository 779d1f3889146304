"""What a process says, line by line: tests wait for its words instead of sleeping."""
import re
import threading

HANG_S = 100  # a wait of this long is a hang


class EventLog:
    """The lines of a stream, read by a thread of its own until the stream ends."""

    def __init__(self, stream):
        self.lines = []
        self.changed = threading.Condition()
        self.ended = False
        self.reader = threading.Thread(target=self.read, args=(stream,), daemon=True)
        self.reader.start()

    def read(self, stream):
        with stream:
            for line in stream:
                with self.changed:
                    self.lines.append(line.rstrip("\n"))
                    self.changed.notify_all()
        with self.changed:
            self.ended = True
            self.changed.notify_all()

    def mark(self):
        """Where the log stands now, as the `since` of a later question."""
        with self.changed:
            return len(self.lines)

    def find(self, pattern, since=0):
        """All matches so far."""
        with self.changed:
            return [match for line in self.lines[since:] if (match := re.search(pattern, line))]

    def wait_for(self, pattern, since=0, times=1):
        """The matches, as soon as there are so many; an AssertionError with the log's end when they do not come."""
        def there():
            found[:] = [match for line in self.lines[since:] if (match := re.search(pattern, line))]
            return len(found) >= times or self.ended

        found = []
        with self.changed:
            self.changed.wait_for(there, timeout=HANG_S)
            if len(found) < times:
                raise AssertionError(f"{times} times {pattern!r} in:\n" + "\n".join(self.lines[-60:]))
        return found
