-- Schema 10: what happened to each job, and since when it waits and has been in its stage.  Times are Unix
-- milliseconds.

CREATE TABLE job_events (
  job_id  TEXT    NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  number  INTEGER NOT NULL CHECK (number >= 1),  -- of the job's events, in order; a gap: some were left out
  time_ms INTEGER NOT NULL,
  event   TEXT    NOT NULL CHECK (length(event) > 0),
  task    INTEGER,                               -- NULL: about the job as a whole
  kind    TEXT    NOT NULL DEFAULT '',           -- of the task
  worker  TEXT    NOT NULL DEFAULT '',
  message TEXT    NOT NULL DEFAULT '',
  PRIMARY KEY (job_id, number)
) STRICT, WITHOUT ROWID;

ALTER TABLE jobs ADD COLUMN queued_ms INTEGER NOT NULL DEFAULT 0;  -- when it was last queued
ALTER TABLE jobs ADD COLUMN stage_ms  INTEGER NOT NULL DEFAULT 0;  -- when its stage began; 0 = not yet, or not known
UPDATE jobs SET queued_ms = created_ms;
