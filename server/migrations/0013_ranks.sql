-- Schema 13: a priority orders an owner's own jobs; across owners it counts only up to what the owner's quota allows.

-- The highest priority that counts, from the server's options at its start; owner '' = whoever is not named.
CREATE TABLE priority_quotas (
  owner TEXT    PRIMARY KEY,
  most  INTEGER NOT NULL
) STRICT, WITHOUT ROWID;

ALTER TABLE queues ADD COLUMN rank INTEGER NOT NULL DEFAULT 0;  -- the lesser of priority and quota
DROP INDEX queues_in_order;
CREATE INDEX queues_in_order ON queues (on_request, needs_core, needs_memory, rank DESC, turn, owner, priority DESC);

DROP TRIGGER tasks_enter_new;
CREATE TRIGGER tasks_enter_new AFTER INSERT ON tasks WHEN NEW.state = 'pending' AND NEW.parked = 0
BEGIN
  INSERT INTO turns (owner, on_request, turn) VALUES (NEW.owner, NEW.on_request, NEW.seq - (1 << 53))
    ON CONFLICT (owner, on_request) DO NOTHING;
  INSERT INTO queues (owner, on_request, needs_core, needs_memory, priority, turn, rank, ready)
    VALUES (NEW.owner, NEW.on_request, NEW.needs_core, NEW.needs_memory, NEW.priority,
      (SELECT turn FROM turns WHERE owner = NEW.owner AND on_request = NEW.on_request),
      min(NEW.priority, coalesce((SELECT most FROM priority_quotas WHERE owner = NEW.owner),
        (SELECT most FROM priority_quotas WHERE owner = ''), 5)), 1)
    ON CONFLICT (owner, on_request, needs_core, needs_memory, priority) DO UPDATE SET ready = ready + 1;
END;
DROP TRIGGER tasks_enter;
CREATE TRIGGER tasks_enter AFTER UPDATE OF state, parked, priority, needs_core, needs_memory ON tasks
WHEN NEW.state = 'pending' AND NEW.parked = 0
BEGIN
  INSERT INTO turns (owner, on_request, turn) VALUES (NEW.owner, NEW.on_request, NEW.seq - (1 << 53))
    ON CONFLICT (owner, on_request) DO NOTHING;
  INSERT INTO queues (owner, on_request, needs_core, needs_memory, priority, turn, rank, ready)
    VALUES (NEW.owner, NEW.on_request, NEW.needs_core, NEW.needs_memory, NEW.priority,
      (SELECT turn FROM turns WHERE owner = NEW.owner AND on_request = NEW.on_request),
      min(NEW.priority, coalesce((SELECT most FROM priority_quotas WHERE owner = NEW.owner),
        (SELECT most FROM priority_quotas WHERE owner = ''), 5)), 1)
    ON CONFLICT (owner, on_request, needs_core, needs_memory, priority) DO UPDATE SET ready = ready + 1;
END;

-- What the maintenance looks for every second, among all tasks.
CREATE INDEX tasks_failed ON tasks (deadline_ms) WHERE state = 'failed';
