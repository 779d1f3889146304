-- Schema 2: operators' divergences and eroded solids among the derived artefacts; a skeleton's quality.
-- SQLite cannot change a CHECK, so the two tables are made anew (foreign keys are off during migrations).

CREATE TABLE artifacts_2 (
  id         INTEGER PRIMARY KEY,
  erosion_id INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  kind       TEXT    NOT NULL CHECK (kind IN ('lattice', 'directions', 'skeleton', 'surface', 'divergence',
                                              'eroded-points', 'eroded-surface')),
  params_key TEXT    NOT NULL,
  bytes      INTEGER NOT NULL CHECK (bytes >= 0),
  sha256     TEXT    NOT NULL CHECK (length(sha256) = 64),
  items      INTEGER NOT NULL CHECK (items >= 0),  -- points, or triangles of a surface
  quality    BLOB,                                 -- of a skeleton
  UNIQUE (erosion_id, kind, params_key)
) STRICT;
INSERT INTO artifacts_2 (id, erosion_id, kind, params_key, bytes, sha256, items)
  SELECT id, erosion_id, kind, params_key, bytes, sha256, items FROM artifacts;
DROP TABLE artifacts;
ALTER TABLE artifacts_2 RENAME TO artifacts;

ALTER TABLE jobs ADD COLUMN quality BLOB;  -- of its own skeleton, when done

CREATE TABLE tasks_2 (
  id             INTEGER PRIMARY KEY,
  job_id         TEXT    NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  kind           TEXT    NOT NULL CHECK (kind IN ('prepare', 'erode', 'skeleton', 'surface', 'divergence',
                                                  'eroded-points', 'eroded-surface')),
  state          TEXT    NOT NULL CHECK (state IN ('pending', 'leased', 'done', 'failed')),
  on_request     INTEGER NOT NULL DEFAULT 0 CHECK (on_request IN (0, 1)),  -- somebody waits for an artefact
  first_position INTEGER,          -- erode: the block, in the order of work
  end_position   INTEGER,
  params         BLOB,             -- of the derived kinds
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
  CHECK ((kind IN ('prepare', 'erode')) = (params_key IS NULL))
) STRICT;
INSERT INTO tasks_2 SELECT * FROM tasks;
DROP TABLE tasks;
ALTER TABLE tasks_2 RENAME TO tasks;
CREATE INDEX tasks_by_job ON tasks (job_id, state);
CREATE INDEX tasks_pending ON tasks (job_id) WHERE state = 'pending';
CREATE INDEX tasks_leased ON tasks (deadline_ms) WHERE state = 'leased';
