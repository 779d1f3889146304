-- Schema 5: checksums of fields, and the queue in the order of work.

-- checksum(erosion_id, idx, data) of each chunk of a field.  A table of its own: chunks are rewritten in
-- place, and a chunk that is lost as a whole is noticed.
CREATE TABLE field_sums (
  erosion_id INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  idx        INTEGER NOT NULL CHECK (idx >= 0),
  sum        INTEGER NOT NULL,
  PRIMARY KEY (erosion_id, idx)
) STRICT, WITHOUT ROWID;
INSERT INTO field_sums (erosion_id, idx, sum)
  SELECT erosion_id, idx, checksum(erosion_id, idx, data) FROM field_chunks;

-- checksum(erosion_id, -1, data)
ALTER TABLE field_log ADD COLUMN sum INTEGER NOT NULL DEFAULT 0;
UPDATE field_log SET sum = checksum(erosion_id, -1, data);

-- What decides when a pending task is its job's turn, copied from the job, so that an index has the order.
ALTER TABLE tasks ADD COLUMN seq INTEGER NOT NULL DEFAULT 0;        -- jobs.seq
ALTER TABLE tasks ADD COLUMN priority INTEGER NOT NULL DEFAULT 0;   -- jobs.priority
ALTER TABLE tasks ADD COLUMN needs_core TEXT NOT NULL DEFAULT '';   -- core version that it needs; '' = any
-- The job is not active, or is to be cancelled.  What is asked for on request is never parked.
ALTER TABLE tasks ADD COLUMN parked INTEGER NOT NULL DEFAULT 0 CHECK (parked IN (0, 1));
-- Lease clock: without progress by then, a leased task is taken back, however often its lease is renewed.
ALTER TABLE tasks ADD COLUMN stalled_ms INTEGER;

UPDATE tasks SET (seq, priority, parked) =
  (SELECT j.seq, j.priority, tasks.on_request = 0 AND (j.state NOT IN ('queued', 'running') OR
                                                       j.cancel_requested = 1)
   FROM jobs j WHERE j.id = tasks.job_id);
UPDATE tasks SET needs_core =
  (SELECT ifnull(e.core_version, '') FROM jobs j JOIN erosions e ON e.id = j.erosion_id
   WHERE j.id = tasks.job_id) WHERE kind = 'erode';

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
