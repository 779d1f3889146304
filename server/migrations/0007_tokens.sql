-- Schema 7: who may call.  Of a token only its SHA-256 is kept; times are Unix milliseconds.

CREATE TABLE tokens (
  id           INTEGER PRIMARY KEY AUTOINCREMENT,  -- never given twice: it stands in logs
  sha256       TEXT    NOT NULL UNIQUE CHECK (length(sha256) = 64),
  owner        TEXT    NOT NULL CHECK (length(owner) > 0),
  role         TEXT    NOT NULL CHECK (role IN ('user', 'worker', 'admin')),
  created_ms   INTEGER NOT NULL,
  expires_ms   INTEGER,
  revoked_ms   INTEGER,
  last_used_ms INTEGER
) STRICT;

-- A request id is the choice of one owner; another's is another.
CREATE TABLE requests_7 (
  owner       TEXT NOT NULL,
  request_id  TEXT NOT NULL,
  job_id      TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  PRIMARY KEY (owner, request_id)
) STRICT, WITHOUT ROWID;
INSERT INTO requests_7 (owner, request_id, job_id)
  SELECT j.owner, r.request_id, r.job_id FROM requests r JOIN jobs j ON j.id = r.job_id;
DROP TABLE requests;
ALTER TABLE requests_7 RENAME TO requests;
CREATE INDEX requests_by_job ON requests (job_id);

UPDATE server_state SET key = 'repeated_job/' WHERE key = 'repeated_job';

-- An owner's jobs, newest first.
CREATE INDEX jobs_by_owner ON jobs (owner, seq);
