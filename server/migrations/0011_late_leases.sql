-- Schema 11: a worker that was silent for longer than its lease may come back.

-- Of a pending task: the token of the lease that ended by silence, until another is granted.  Worker, host and times of
-- that lease stay, too.
ALTER TABLE tasks ADD COLUMN late_token TEXT CHECK (late_token IS NULL OR state = 'pending');
CREATE UNIQUE INDEX tasks_late ON tasks (late_token) WHERE late_token IS NOT NULL;
