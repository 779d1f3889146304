-- Schema 8: whose turn it is.  Within a priority the owners of jobs take turns, on workers whose memory is enough.

ALTER TABLE tasks ADD COLUMN owner TEXT NOT NULL DEFAULT '';  -- jobs.owner
-- Number of the last grant to its job, where the jobs of an owner take turns; 0 = never, or they come in order.
ALTER TABLE tasks ADD COLUMN turn INTEGER NOT NULL DEFAULT 0;
-- Bytes of memory that a worker must have, see store/memory_need.h; 0 = any worker will do.
ALTER TABLE tasks ADD COLUMN needs_memory INTEGER NOT NULL DEFAULT 0 CHECK (needs_memory >= 0);

-- Number of the last grant to an owner.  Negative before the first: in the order in which owners came.
CREATE TABLE turns (
  owner      TEXT    NOT NULL,
  on_request INTEGER NOT NULL CHECK (on_request IN (0, 1)),
  turn       INTEGER NOT NULL,
  PRIMARY KEY (owner, on_request)
) STRICT, WITHOUT ROWID;
CREATE INDEX turns_in_order ON turns (turn);

-- The owners that have ready tasks (pending and not parked): one row for every kind of need and priority.
CREATE TABLE queues (
  owner        TEXT    NOT NULL,
  on_request   INTEGER NOT NULL,
  needs_core   TEXT    NOT NULL,
  needs_memory INTEGER NOT NULL,
  priority     INTEGER NOT NULL,
  turn         INTEGER NOT NULL,                    -- turns.turn, copied so that the index has the order
  ready        INTEGER NOT NULL CHECK (ready >= 0), -- tasks; 0 only while a trigger runs
  PRIMARY KEY (owner, on_request, needs_core, needs_memory, priority)
) STRICT, WITHOUT ROWID;
CREATE INDEX queues_in_order ON queues (on_request, needs_core, needs_memory, priority DESC, turn, owner);

UPDATE tasks SET owner = (SELECT owner FROM jobs WHERE id = tasks.job_id);
INSERT INTO turns (owner, on_request, turn)
  SELECT owner, on_request, min(seq) - (1 << 53) FROM tasks GROUP BY owner, on_request;
INSERT INTO queues (owner, on_request, needs_core, needs_memory, priority, turn, ready)
  SELECT owner, on_request, needs_core, needs_memory, priority,
    (SELECT turn FROM turns WHERE owner = tasks.owner AND on_request = tasks.on_request), count(*)
  FROM tasks WHERE state = 'pending' AND parked = 0
  GROUP BY owner, on_request, needs_core, needs_memory, priority;

DROP INDEX tasks_ready;
CREATE INDEX tasks_ready ON tasks (on_request, needs_core, needs_memory, priority, owner, turn, seq, id)
  WHERE state = 'pending' AND parked = 0;
CREATE INDEX tasks_of_owner_held ON tasks (owner, worker) WHERE state = 'leased' AND on_request = 0;

-- A task becomes ready, or is so no longer.
CREATE TRIGGER tasks_enter_new AFTER INSERT ON tasks WHEN NEW.state = 'pending' AND NEW.parked = 0
BEGIN
  INSERT INTO turns (owner, on_request, turn) VALUES (NEW.owner, NEW.on_request, NEW.seq - (1 << 53))
    ON CONFLICT (owner, on_request) DO NOTHING;
  INSERT INTO queues (owner, on_request, needs_core, needs_memory, priority, turn, ready)
    VALUES (NEW.owner, NEW.on_request, NEW.needs_core, NEW.needs_memory, NEW.priority,
      (SELECT turn FROM turns WHERE owner = NEW.owner AND on_request = NEW.on_request), 1)
    ON CONFLICT (owner, on_request, needs_core, needs_memory, priority) DO UPDATE SET ready = ready + 1;
END;
CREATE TRIGGER tasks_enter AFTER UPDATE OF state, parked, priority, needs_core, needs_memory ON tasks
WHEN NEW.state = 'pending' AND NEW.parked = 0
BEGIN
  INSERT INTO turns (owner, on_request, turn) VALUES (NEW.owner, NEW.on_request, NEW.seq - (1 << 53))
    ON CONFLICT (owner, on_request) DO NOTHING;
  INSERT INTO queues (owner, on_request, needs_core, needs_memory, priority, turn, ready)
    VALUES (NEW.owner, NEW.on_request, NEW.needs_core, NEW.needs_memory, NEW.priority,
      (SELECT turn FROM turns WHERE owner = NEW.owner AND on_request = NEW.on_request), 1)
    ON CONFLICT (owner, on_request, needs_core, needs_memory, priority) DO UPDATE SET ready = ready + 1;
END;
CREATE TRIGGER tasks_leave AFTER UPDATE OF state, parked, priority, needs_core, needs_memory ON tasks
WHEN OLD.state = 'pending' AND OLD.parked = 0
BEGIN
  UPDATE queues SET ready = ready - 1 WHERE owner = OLD.owner AND on_request = OLD.on_request
    AND needs_core = OLD.needs_core AND needs_memory = OLD.needs_memory AND priority = OLD.priority;
  DELETE FROM queues WHERE owner = OLD.owner AND on_request = OLD.on_request
    AND needs_core = OLD.needs_core AND needs_memory = OLD.needs_memory AND priority = OLD.priority AND ready = 0;
END;
CREATE TRIGGER tasks_leave_for_good AFTER DELETE ON tasks WHEN OLD.state = 'pending' AND OLD.parked = 0
BEGIN
  UPDATE queues SET ready = ready - 1 WHERE owner = OLD.owner AND on_request = OLD.on_request
    AND needs_core = OLD.needs_core AND needs_memory = OLD.needs_memory AND priority = OLD.priority;
  DELETE FROM queues WHERE owner = OLD.owner AND on_request = OLD.on_request
    AND needs_core = OLD.needs_core AND needs_memory = OLD.needs_memory AND priority = OLD.priority AND ready = 0;
END;
