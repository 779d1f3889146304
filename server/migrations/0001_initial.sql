-- Schema 1.  Times are Unix milliseconds; lease times are those of the server's lease clock (see clock.h).
-- Serialized messages (BLOBs named params, skeleton, prepared) are those of proto/affskel/v1.

PRAGMA application_id = 1095127883;  -- "AFSK"

-- Submitted meshes, byte for byte, shared by all jobs that were given the same bytes.
CREATE TABLE meshes (
  sha256     TEXT    PRIMARY KEY CHECK (length(sha256) = 64),
  bytes      INTEGER NOT NULL CHECK (bytes > 0),
  created_ms INTEGER NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TABLE mesh_chunks (
  sha256 TEXT    NOT NULL REFERENCES meshes (sha256) ON DELETE CASCADE,
  idx    INTEGER NOT NULL CHECK (idx >= 0),
  data   BLOB    NOT NULL CHECK (length(data) BETWEEN 1 AND 1048576),
  PRIMARY KEY (sha256, idx)
) STRICT;

CREATE TRIGGER meshes_are_immutable BEFORE UPDATE ON meshes
BEGIN SELECT RAISE(ABORT, 'a stored mesh is never changed'); END;

CREATE TRIGGER mesh_chunks_are_immutable BEFORE UPDATE ON mesh_chunks
BEGIN SELECT RAISE(ABORT, 'a stored mesh is never changed'); END;

-- One computation of a field: a function of (mesh, params_key, core_version).  Owned by one job until it
-- is finished, then shared by every job that asks for the same.
CREATE TABLE erosions (
  id              INTEGER PRIMARY KEY,
  mesh_sha256     TEXT    NOT NULL REFERENCES meshes (sha256),
  params          BLOB    NOT NULL,
  params_key      TEXT    NOT NULL,
  core_version    TEXT,             -- of the worker that prepared it; NULL before
  prepared        BLOB,
  points          INTEGER CHECK (points BETWEEN 0 AND 4294967295),
  directions      INTEGER CHECK (directions BETWEEN 1 AND 4294967294),
  stride          INTEGER CHECK (stride >= 1),
  directions_done INTEGER NOT NULL DEFAULT 0 CHECK (directions_done BETWEEN 0 AND ifnull(directions, 0)),
  finished        INTEGER NOT NULL DEFAULT 0 CHECK (finished IN (0, 1)),
  CHECK ((core_version IS NULL) = (prepared IS NULL)),
  CHECK ((core_version IS NULL) = (points IS NULL)),
  CHECK ((core_version IS NULL) = (directions IS NULL)),
  CHECK ((core_version IS NULL) = (stride IS NULL)),
  CHECK (finished = 0 OR directions_done IS directions)
) STRICT;
CREATE INDEX erosions_by_content ON erosions (mesh_sha256, params_key);

-- The field: records of 20 bytes by point, 4096 to a chunk; a chunk that no report has touched is absent.
CREATE TABLE field_chunks (
  id         INTEGER PRIMARY KEY,
  erosion_id INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  idx        INTEGER NOT NULL CHECK (idx >= 0),
  data       BLOB    NOT NULL CHECK (length(data) BETWEEN 20 AND 81920 AND length(data) % 20 = 0),
  UNIQUE (erosion_id, idx)
) STRICT;

-- Finished positions in the order of work: disjoint half-open ranges, none touching the next.
CREATE TABLE done_ranges (
  erosion_id     INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  first_position INTEGER NOT NULL CHECK (first_position >= 0),
  end_position   INTEGER NOT NULL CHECK (end_position > first_position),
  PRIMARY KEY (erosion_id, first_position)
) STRICT, WITHOUT ROWID;

-- What was derived from mesh and parameters (lattice, directions) or from the field (skeleton, surface).
CREATE TABLE artifacts (
  id         INTEGER PRIMARY KEY,
  erosion_id INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  kind       TEXT    NOT NULL CHECK (kind IN ('lattice', 'directions', 'skeleton', 'surface')),
  params_key TEXT    NOT NULL,
  bytes      INTEGER NOT NULL CHECK (bytes >= 0),
  sha256     TEXT    NOT NULL CHECK (length(sha256) = 64),
  items      INTEGER NOT NULL CHECK (items >= 0),  -- points of a skeleton, triangles of a surface
  UNIQUE (erosion_id, kind, params_key)
) STRICT;

CREATE TABLE artifact_chunks (
  artifact_id INTEGER NOT NULL REFERENCES artifacts (id) ON DELETE CASCADE,
  idx         INTEGER NOT NULL CHECK (idx >= 0),
  data        BLOB    NOT NULL CHECK (length(data) BETWEEN 1 AND 1048576),
  PRIMARY KEY (artifact_id, idx)
) STRICT;

CREATE TABLE jobs (
  seq              INTEGER PRIMARY KEY AUTOINCREMENT,  -- order of submission
  id               TEXT    NOT NULL UNIQUE CHECK (length(id) = 32),
  name             TEXT    NOT NULL,
  owner            TEXT    NOT NULL,
  priority         INTEGER NOT NULL CHECK (priority BETWEEN 0 AND 9),
  state            TEXT    NOT NULL CHECK (state IN ('queued', 'running', 'done', 'failed', 'cancelled')),
  stage            TEXT    NOT NULL CHECK (stage IN ('prepare', 'erode', 'derive', 'complete')),
  erosion_id       INTEGER NOT NULL REFERENCES erosions (id),
  skeleton         BLOB    NOT NULL,
  skeleton_key     TEXT    NOT NULL,
  skeleton_points  INTEGER NOT NULL DEFAULT 0,
  created_ms       INTEGER NOT NULL,
  started_ms       INTEGER NOT NULL DEFAULT 0,
  finished_ms      INTEGER NOT NULL DEFAULT 0,
  cancel_requested INTEGER NOT NULL DEFAULT 0 CHECK (cancel_requested IN (0, 1)),
  error_code       TEXT,
  error_message    TEXT    NOT NULL DEFAULT '',
  error_line       INTEGER NOT NULL DEFAULT 0,
  directions_reported INTEGER NOT NULL DEFAULT 0,
  directions_repeated INTEGER NOT NULL DEFAULT 0,
  reports             INTEGER NOT NULL DEFAULT 0,
  leases_granted      INTEGER NOT NULL DEFAULT 0,
  leases_lost         INTEGER NOT NULL DEFAULT 0,
  longest_gap_ms      INTEGER NOT NULL DEFAULT 0,
  directions_lost     REAL    NOT NULL DEFAULT 0,
  CHECK ((state = 'done') = (stage = 'complete')),
  CHECK ((state = 'failed') = (error_code IS NOT NULL))
) STRICT;
CREATE INDEX jobs_by_state ON jobs (state);
CREATE INDEX jobs_by_erosion ON jobs (erosion_id);

-- Client-chosen keys of submissions, so that a repeated submission is recognised.
CREATE TABLE requests (
  request_id  TEXT PRIMARY KEY,
  content_key TEXT NOT NULL,
  job_id      TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE
) STRICT, WITHOUT ROWID;
CREATE INDEX requests_by_job ON requests (job_id);

-- Units of work.  A lease is the token and the columns after it.
CREATE TABLE tasks (
  id             INTEGER PRIMARY KEY,
  job_id         TEXT    NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  kind           TEXT    NOT NULL CHECK (kind IN ('prepare', 'erode', 'skeleton', 'surface')),
  state          TEXT    NOT NULL CHECK (state IN ('pending', 'leased', 'done', 'failed')),
  on_request     INTEGER NOT NULL DEFAULT 0 CHECK (on_request IN (0, 1)),  -- somebody waits for an artefact
  first_position INTEGER,          -- erode: the block, in the order of work
  end_position   INTEGER,
  params         BLOB,             -- skeleton, surface
  params_key     TEXT,
  losses         INTEGER NOT NULL DEFAULT 0,  -- leases lost since the last progress
  error_code     TEXT,
  error_message  TEXT    NOT NULL DEFAULT '',
  token          TEXT    UNIQUE,   -- kept when done, so that a repeated last report is recognised
  worker         TEXT,
  host           TEXT,
  pid            INTEGER,
  supervised     INTEGER,
  core_version   TEXT,
  granted_ms     INTEGER,
  reported_ms    INTEGER,          -- last report, NULL before the first
  deadline_ms    INTEGER,
  lease_directions INTEGER NOT NULL DEFAULT 0,  -- reported under this lease
  CHECK (state <> 'leased' OR (token IS NOT NULL AND deadline_ms IS NOT NULL AND granted_ms IS NOT NULL)),
  CHECK (state <> 'pending' OR token IS NULL),
  CHECK ((state = 'failed') = (error_code IS NOT NULL)),
  CHECK ((kind = 'erode') = (first_position IS NOT NULL)),
  CHECK (first_position IS NULL OR (first_position >= 0 AND end_position > first_position)),
  CHECK ((kind IN ('skeleton', 'surface')) = (params_key IS NOT NULL))
) STRICT;
CREATE INDEX tasks_by_job ON tasks (job_id, state);
CREATE INDEX tasks_pending ON tasks (job_id) WHERE state = 'pending';
CREATE INDEX tasks_leased ON tasks (deadline_ms) WHERE state = 'leased';

-- What the server remembers about itself.
CREATE TABLE server_state (
  key   TEXT PRIMARY KEY,
  value TEXT NOT NULL
) STRICT, WITHOUT ROWID;
