-- Schema 6: the kinds of tasks and of artefacts are tables, which the server fills from wire/artifact_kinds.h when it
-- starts: a new kind needs no migration.  SQLite cannot change a CHECK, so the two tables that had the names in one
-- are made anew.

CREATE TABLE task_kinds (name TEXT PRIMARY KEY) STRICT, WITHOUT ROWID;
CREATE TABLE artifact_kinds (name TEXT PRIMARY KEY) STRICT, WITHOUT ROWID;
INSERT INTO task_kinds (name) VALUES ('prepare'), ('erode'), ('skeleton'), ('surface'), ('divergence'),
  ('eroded-points'), ('eroded-surface');
INSERT INTO artifact_kinds (name) VALUES ('lattice'), ('directions'), ('skeleton'), ('surface'), ('divergence'),
  ('eroded-points'), ('eroded-surface');

CREATE TABLE artifacts_6 (
  id         INTEGER PRIMARY KEY,
  erosion_id INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  kind       TEXT    NOT NULL REFERENCES artifact_kinds (name),
  params_key TEXT    NOT NULL,
  bytes      INTEGER NOT NULL CHECK (bytes >= 0),
  sha256     TEXT    NOT NULL CHECK (length(sha256) = 64),
  items      INTEGER NOT NULL CHECK (items >= 0),  -- points, or triangles of a surface
  quality    BLOB,                                 -- of a skeleton
  UNIQUE (erosion_id, kind, params_key)
) STRICT;
INSERT INTO artifacts_6 (id, erosion_id, kind, params_key, bytes, sha256, items, quality)
  SELECT id, erosion_id, kind, params_key, bytes, sha256, items, quality FROM artifacts;
DROP TABLE artifacts;
ALTER TABLE artifacts_6 RENAME TO artifacts;

DROP TRIGGER jobs_park_their_tasks;
CREATE TABLE tasks_6 (
  id             INTEGER PRIMARY KEY,
  job_id         TEXT    NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  kind           TEXT    NOT NULL REFERENCES task_kinds (name),
  state          TEXT    NOT NULL CHECK (state IN ('pending', 'leased', 'done', 'failed')),
  on_request     INTEGER NOT NULL DEFAULT 0 CHECK (on_request IN (0, 1)),  -- somebody waits for an artefact
  first_position INTEGER,          -- erode: the block, in the order of work
  end_position   INTEGER,
  params         BLOB,             -- of the derived kinds
  params_key     TEXT,
  losses         INTEGER NOT NULL DEFAULT 0,  -- leases lost since the last progress
  error_code     TEXT,
  error_message  TEXT    NOT NULL DEFAULT '',
  -- What decides when a pending task is its job's turn, copied from the job, so that an index has the order.
  seq            INTEGER NOT NULL DEFAULT 0,   -- jobs.seq
  priority       INTEGER NOT NULL DEFAULT 0,   -- jobs.priority
  needs_core     TEXT    NOT NULL DEFAULT '',  -- core version that it needs; '' = any
  -- The job is not active, or is to be cancelled.  What is asked for on request is never parked.
  parked         INTEGER NOT NULL DEFAULT 0 CHECK (parked IN (0, 1)),
  token          TEXT    UNIQUE,   -- kept when done, so that a repeated last report is recognised
  worker         TEXT,
  host           TEXT,
  pid            INTEGER,
  supervised     INTEGER,
  core_version   TEXT,
  granted_ms     INTEGER,
  reported_ms    INTEGER,          -- last report, NULL before the first
  deadline_ms    INTEGER,
  -- Lease clock: without progress by then, a leased task is taken back, however often its lease is renewed.
  stalled_ms     INTEGER,
  lease_directions INTEGER NOT NULL DEFAULT 0,  -- reported under this lease
  CHECK (state <> 'leased' OR (token IS NOT NULL AND deadline_ms IS NOT NULL AND granted_ms IS NOT NULL)),
  CHECK (state <> 'pending' OR token IS NULL),
  CHECK ((state = 'failed') = (error_code IS NOT NULL)),
  CHECK ((kind = 'erode') = (first_position IS NOT NULL)),
  CHECK (first_position IS NULL OR (first_position >= 0 AND end_position > first_position)),
  CHECK ((kind IN ('prepare', 'erode')) = (params_key IS NULL))
) STRICT;
INSERT INTO tasks_6 (id, job_id, kind, state, on_request, first_position, end_position, params, params_key, losses,
    error_code, error_message, seq, priority, needs_core, parked, token, worker, host, pid, supervised, core_version,
    granted_ms, reported_ms, deadline_ms, stalled_ms, lease_directions)
  SELECT id, job_id, kind, state, on_request, first_position, end_position, params, params_key, losses,
    error_code, error_message, seq, priority, needs_core, parked, token, worker, host, pid, supervised, core_version,
    granted_ms, reported_ms, deadline_ms, stalled_ms, lease_directions FROM tasks;
DROP TABLE tasks;
ALTER TABLE tasks_6 RENAME TO tasks;
CREATE INDEX tasks_by_job ON tasks (job_id, state);
CREATE INDEX tasks_pending ON tasks (job_id) WHERE state = 'pending';
CREATE INDEX tasks_leased ON tasks (deadline_ms) WHERE state = 'leased';
CREATE INDEX tasks_ready ON tasks (on_request, needs_core, priority DESC, seq, id)
  WHERE state = 'pending' AND parked = 0;
CREATE INDEX tasks_held ON tasks (worker) WHERE state = 'leased';

CREATE TRIGGER jobs_park_their_tasks AFTER UPDATE OF state, cancel_requested, priority ON jobs
WHEN OLD.priority <> NEW.priority OR
  (OLD.state IN ('queued', 'running') AND OLD.cancel_requested = 0) <>
  (NEW.state IN ('queued', 'running') AND NEW.cancel_requested = 0)
BEGIN
  UPDATE tasks SET priority = NEW.priority,
    parked = on_request = 0 AND NOT (NEW.state IN ('queued', 'running') AND NEW.cancel_requested = 0)
    WHERE job_id = NEW.id;
END;
