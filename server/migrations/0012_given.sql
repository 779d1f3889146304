-- Schema 12: who gave what, and what of it was computed again by others.

-- The positions of which a worker has told anything: that they are done, or a value of their directions.  Disjoint
-- half-open ranges of each worker, none touching its next; those of two workers may overlap, where work was repeated.
CREATE TABLE given_ranges (
  erosion_id     INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  worker         TEXT    NOT NULL,
  host           TEXT    NOT NULL,
  first_position INTEGER NOT NULL CHECK (first_position >= 0),
  end_position   INTEGER NOT NULL CHECK (end_position > first_position),
  PRIMARY KEY (erosion_id, worker, first_position)
) STRICT, WITHOUT ROWID;

-- Raised when values are taken out of the field: what workers hold of it knows too much from then on.
ALTER TABLE erosions ADD COLUMN revision INTEGER NOT NULL DEFAULT 0;

-- Workers that an administrator distrusts: no lease is given to them.
CREATE TABLE distrusted (
  worker      TEXT    PRIMARY KEY,
  host        TEXT    NOT NULL,
  since_ms    INTEGER NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TABLE verifications (
  id         INTEGER PRIMARY KEY AUTOINCREMENT,
  job_id     TEXT    NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  created_ms INTEGER NOT NULL
) STRICT;
CREATE INDEX verifications_by_job ON verifications (job_id);

-- Directions that the same workers gave, for a task to compute again.
CREATE TABLE samples (
  id              INTEGER PRIMARY KEY AUTOINCREMENT,
  verification_id INTEGER NOT NULL REFERENCES verifications (id) ON DELETE CASCADE,
  task_id         INTEGER NOT NULL DEFAULT 0,
  directions      INTEGER NOT NULL CHECK (directions > 0),
  state           TEXT    NOT NULL DEFAULT 'pending' CHECK (state IN ('pending', 'done', 'failed')),
  verifier        TEXT    NOT NULL DEFAULT '',
  host            TEXT    NOT NULL DEFAULT '',          -- of the verifier
  compared        INTEGER NOT NULL DEFAULT 0,           -- stored values that one of the directions gave
  differing       INTEGER NOT NULL DEFAULT 0,           -- points
  message         TEXT    NOT NULL DEFAULT ''           -- the first difference, or why the task failed
) STRICT;
CREATE INDEX samples_by_verification ON samples (verification_id);

CREATE TABLE sample_givers (
  sample_id INTEGER NOT NULL REFERENCES samples (id) ON DELETE CASCADE,
  worker    TEXT    NOT NULL,
  host      TEXT    NOT NULL,
  PRIMARY KEY (sample_id, worker)
) STRICT, WITHOUT ROWID;

-- A task to verify stands in no owner's queue, for not everybody may take it: it is parked for good.
CREATE INDEX tasks_to_verify ON tasks (id) WHERE kind = 'verify' AND state = 'pending';
DROP TRIGGER jobs_park_their_tasks;
CREATE TRIGGER jobs_park_their_tasks AFTER UPDATE OF state, cancel_requested, priority ON jobs
WHEN OLD.priority <> NEW.priority OR
  (OLD.state IN ('queued', 'running') AND OLD.cancel_requested = 0) <>
  (NEW.state IN ('queued', 'running') AND NEW.cancel_requested = 0)
BEGIN
  UPDATE tasks SET priority = NEW.priority,
    parked = kind = 'verify' OR
      on_request = 0 AND NOT (NEW.state IN ('queued', 'running') AND NEW.cancel_requested = 0)
    WHERE job_id = NEW.id;
END;

-- What a job computes, for a submission that may be the same again: to find out costs the same, however many jobs
-- its owner has.
ALTER TABLE jobs ADD COLUMN content TEXT NOT NULL DEFAULT '';
UPDATE jobs SET content = (SELECT mesh_sha256 || ' ' || params_key FROM erosions WHERE id = jobs.erosion_id);
CREATE INDEX jobs_by_content ON jobs (owner, name, content, skeleton_key);
