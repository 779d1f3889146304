-- Schema 1.  Times are Unix milliseconds; lease times are those of the server's lease clock (see clock.h).
-- Serialized messages (BLOBs named params, skeleton, prepared) are those of proto/affskel/v1.

PRAGMA application_id = 1095127884;  -- "AFSL"

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

-- Meshes of which some chunks may be gone already.  (A mark in meshes would be a change to a stored mesh.)
CREATE TABLE dropped_meshes (
  sha256 TEXT PRIMARY KEY REFERENCES meshes (sha256) ON DELETE CASCADE
) STRICT, WITHOUT ROWID;

-- One computation of a field: a function of (mesh, params_key, core_version).  Owned by one job until it is finished,
-- then shared by every job that asks for the same.
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
  dropped         INTEGER NOT NULL DEFAULT 0 CHECK (dropped IN (0, 1)),  -- to be deleted piece by piece
  -- Bytes of the field, once it is known how large it becomes, and of the artefacts.
  bytes           INTEGER NOT NULL DEFAULT 0,
  -- Raised when values are taken out of the field: what workers hold of it knows too much from then on.
  revision        INTEGER NOT NULL DEFAULT 0,
  mesh_bytes      INTEGER NOT NULL DEFAULT 0,  -- a copy, so that lists of jobs need no look at their meshes
  CHECK ((core_version IS NULL) = (prepared IS NULL)),
  CHECK ((core_version IS NULL) = (points IS NULL)),
  CHECK ((core_version IS NULL) = (directions IS NULL)),
  CHECK ((core_version IS NULL) = (stride IS NULL)),
  CHECK (finished = 0 OR directions_done IS directions)
) STRICT;
CREATE INDEX erosions_by_content ON erosions (mesh_sha256, params_key);
CREATE INDEX erosions_dropped ON erosions (id) WHERE dropped = 1;

CREATE TRIGGER erosions_copy_mesh_bytes AFTER INSERT ON erosions
BEGIN
  UPDATE erosions SET mesh_bytes = (SELECT bytes FROM meshes WHERE sha256 = NEW.mesh_sha256) WHERE id = NEW.id;
END;

-- The field: records of 20 bytes by point, 4096 to a chunk; a chunk that no report has touched is absent.
CREATE TABLE field_chunks (
  id         INTEGER PRIMARY KEY,
  erosion_id INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  idx        INTEGER NOT NULL CHECK (idx >= 0),
  data       BLOB    NOT NULL CHECK (length(data) BETWEEN 20 AND 81920 AND length(data) % 20 = 0),
  UNIQUE (erosion_id, idx)
) STRICT;

-- checksum(erosion_id, idx, data) of each chunk of a field.  A table of its own: chunks are rewritten in place, and a
-- chunk that is lost as a whole is noticed.
CREATE TABLE field_sums (
  erosion_id INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  idx        INTEGER NOT NULL CHECK (idx >= 0),
  sum        INTEGER NOT NULL,
  PRIMARY KEY (erosion_id, idx)
) STRICT, WITHOUT ROWID;

-- Records of reports that are not merged into the field's chunks yet.  Late in an erosion a report improves a few
-- points of every chunk; merging each at once would write the whole field every second.
CREATE TABLE field_log (
  id         INTEGER PRIMARY KEY,
  erosion_id INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  -- Records of 24 bytes: E and area (float64), direction and point (uint32), little-endian.
  data       BLOB    NOT NULL CHECK (length(data) >= 24 AND length(data) % 24 = 0),
  sum        INTEGER NOT NULL DEFAULT 0   -- checksum(erosion_id, -1, data)
) STRICT;
CREATE INDEX field_log_by_erosion ON field_log (erosion_id);

-- Finished positions in the order of work: disjoint half-open ranges, none touching the next.
CREATE TABLE done_ranges (
  erosion_id     INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  first_position INTEGER NOT NULL CHECK (first_position >= 0),
  end_position   INTEGER NOT NULL CHECK (end_position > first_position),
  PRIMARY KEY (erosion_id, first_position)
) STRICT, WITHOUT ROWID;

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

-- Workers that an administrator distrusts: no lease is given to them.
CREATE TABLE distrusted (
  worker      TEXT    PRIMARY KEY,
  host        TEXT    NOT NULL,
  since_ms    INTEGER NOT NULL
) STRICT, WITHOUT ROWID;

-- The kinds of tasks and of artefacts, which the server fills from wire/artifact_kinds.h when it starts: a new kind
-- needs no migration.
CREATE TABLE task_kinds (name TEXT PRIMARY KEY) STRICT, WITHOUT ROWID;

CREATE TABLE artifact_kinds (name TEXT PRIMARY KEY) STRICT, WITHOUT ROWID;

-- What was derived from mesh and parameters (lattice, directions) or from the field (skeleton, surface).
CREATE TABLE artifacts (
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
  quality    BLOB,                         -- of the skeleton
  pinned     INTEGER NOT NULL DEFAULT 0 CHECK (pinned IN (0, 1)),
  -- When retention removed its results: its erosion is then another one, of which nothing is stored.  0 = they are
  -- kept.
  removed_ms INTEGER NOT NULL DEFAULT 0,
  -- When retention is going to remove its results or, when they are gone, the job itself.  0 = not planned.
  expires_ms INTEGER NOT NULL DEFAULT 0,
  queued_ms  INTEGER NOT NULL DEFAULT 0,   -- since when it waits
  stage_ms   INTEGER NOT NULL DEFAULT 0,   -- since when it has been in its stage
  -- What it computes, for a submission that may be the same again: to find out costs the same, however many jobs its
  -- owner has.
  content    TEXT    NOT NULL DEFAULT '',
  CHECK ((state = 'done') = (stage = 'complete')),
  CHECK ((state = 'failed') = (error_code IS NOT NULL))
) STRICT;
CREATE INDEX jobs_by_state ON jobs (state);
CREATE INDEX jobs_by_erosion ON jobs (erosion_id);

-- An owner's jobs, newest first.
CREATE INDEX jobs_by_owner ON jobs (owner, seq);

CREATE INDEX jobs_by_content ON jobs (owner, name, content, skeleton_key);

-- Oldest first, of an owner's jobs with and without results.
CREATE INDEX jobs_to_expire ON jobs (owner, (removed_ms > 0), finished_ms)
  WHERE pinned = 0 AND expires_ms = 0 AND finished_ms > 0;
CREATE INDEX jobs_expiring ON jobs (expires_ms) WHERE expires_ms > 0;

-- Client-chosen keys of submissions, so that a repeated submission is recognised.  A key is the choice of one owner;
-- another's is another.
CREATE TABLE requests (
  owner       TEXT NOT NULL,
  request_id  TEXT NOT NULL,
  job_id      TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
  PRIMARY KEY (owner, request_id)
) STRICT, WITHOUT ROWID;
CREATE INDEX requests_by_job ON requests (job_id);

-- What happened to each job.
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

-- Units of work.  A lease is the token and the columns after it.
CREATE TABLE tasks (
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
  owner          TEXT    NOT NULL DEFAULT '',  -- jobs.owner
  -- Number of the last grant to its job, where the jobs of an owner take turns; 0 = never, or they come in order.
  turn           INTEGER NOT NULL DEFAULT 0,
  -- Bytes of memory that a worker must have, see store/memory_need.h; 0 = any worker will do.
  needs_memory   INTEGER NOT NULL DEFAULT 0 CHECK (needs_memory >= 0),
  -- Of a pending task: the token of the lease that ended by silence, until another is granted.  Worker, host and times
  -- of that lease stay, too.
  late_token     TEXT CHECK (late_token IS NULL OR state = 'pending'),
  CHECK (state <> 'leased' OR (token IS NOT NULL AND deadline_ms IS NOT NULL AND granted_ms IS NOT NULL)),
  CHECK (state <> 'pending' OR token IS NULL),
  CHECK ((state = 'failed') = (error_code IS NOT NULL)),
  CHECK ((kind = 'erode') = (first_position IS NOT NULL)),
  CHECK (first_position IS NULL OR (first_position >= 0 AND end_position > first_position)),
  CHECK ((kind IN ('prepare', 'erode')) = (params_key IS NULL))
) STRICT;
CREATE INDEX tasks_by_job ON tasks (job_id, state);
CREATE INDEX tasks_pending ON tasks (job_id) WHERE state = 'pending';
CREATE INDEX tasks_leased ON tasks (deadline_ms) WHERE state = 'leased';
CREATE INDEX tasks_held ON tasks (worker) WHERE state = 'leased';
CREATE INDEX tasks_of_owner_held ON tasks (owner, worker) WHERE state = 'leased' AND on_request = 0;
CREATE INDEX tasks_ready ON tasks (on_request, needs_core, needs_memory, priority, owner, turn, seq, id)
  WHERE state = 'pending' AND parked = 0;
CREATE UNIQUE INDEX tasks_late ON tasks (late_token) WHERE late_token IS NOT NULL;
CREATE INDEX tasks_to_verify ON tasks (id) WHERE kind = 'verify' AND state = 'pending';

-- What the maintenance looks for every second, among all tasks.
CREATE INDEX tasks_failed ON tasks (deadline_ms) WHERE state = 'failed';

-- The few tasks for which a worker had too little memory.
CREATE INDEX tasks_in_need ON tasks (job_id) WHERE state = 'pending' AND parked = 0 AND needs_memory > 0;

-- A task to verify stands in no owner's queue, for not every worker may take it: it is parked for good.
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

-- Number of the last grant to an owner.  Negative before the first: in the order in which owners came.
CREATE TABLE turns (
  owner      TEXT    NOT NULL,
  on_request INTEGER NOT NULL CHECK (on_request IN (0, 1)),
  turn       INTEGER NOT NULL,
  PRIMARY KEY (owner, on_request)
) STRICT, WITHOUT ROWID;
CREATE INDEX turns_in_order ON turns (turn);

-- The highest priority that counts, from the server's options at its start; owner '' = all that are not named.
CREATE TABLE priority_quotas (
  owner TEXT    PRIMARY KEY,
  most  INTEGER NOT NULL
) STRICT, WITHOUT ROWID;

-- The owners that have ready tasks (pending and not parked): one row for every kind of need and priority.
CREATE TABLE queues (
  owner        TEXT    NOT NULL,
  on_request   INTEGER NOT NULL,
  needs_core   TEXT    NOT NULL,
  needs_memory INTEGER NOT NULL,
  priority     INTEGER NOT NULL,
  turn         INTEGER NOT NULL,                    -- turns.turn, copied so that the index has the order
  ready        INTEGER NOT NULL CHECK (ready >= 0),  -- tasks; 0 only while a trigger runs
  rank         INTEGER NOT NULL DEFAULT 0,          -- the priority as far as it counts across owners
  PRIMARY KEY (owner, on_request, needs_core, needs_memory, priority)
) STRICT, WITHOUT ROWID;
CREATE INDEX queues_in_order ON queues (on_request, needs_core, needs_memory, rank DESC, turn, owner, priority DESC);

-- A task becomes ready, or is so no longer.
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

-- What an owner has: everything once, however many jobs share it.  Kept by the triggers below.
CREATE TABLE owner_use (
  owner        TEXT    PRIMARY KEY,
  queued_jobs  INTEGER NOT NULL DEFAULT 0,  -- queued or running
  mesh_bytes   INTEGER NOT NULL DEFAULT 0,
  stored_bytes INTEGER NOT NULL DEFAULT 0   -- meshes, fields and artefacts
) STRICT, WITHOUT ROWID;

CREATE TABLE owner_erosions (
  owner      TEXT    NOT NULL,
  erosion_id INTEGER NOT NULL,
  jobs       INTEGER NOT NULL,  -- of the owner, with this erosion
  PRIMARY KEY (owner, erosion_id)
) STRICT, WITHOUT ROWID;
CREATE INDEX owner_erosions_by_erosion ON owner_erosions (erosion_id);

CREATE TABLE owner_meshes (
  owner    TEXT    NOT NULL,
  sha256   TEXT    NOT NULL,
  erosions INTEGER NOT NULL,  -- of the owner, of this mesh
  PRIMARY KEY (owner, sha256)
) STRICT, WITHOUT ROWID;

CREATE TRIGGER artifacts_add_bytes AFTER INSERT ON artifacts
BEGIN UPDATE erosions SET bytes = bytes + NEW.bytes WHERE id = NEW.erosion_id; END;

CREATE TRIGGER artifacts_take_bytes AFTER DELETE ON artifacts
BEGIN UPDATE erosions SET bytes = bytes - OLD.bytes WHERE id = OLD.erosion_id; END;

CREATE TRIGGER fields_change_bytes AFTER UPDATE OF points ON erosions
BEGIN
  UPDATE erosions SET bytes = bytes + 20 * (ifnull(NEW.points, 0) - ifnull(OLD.points, 0)) WHERE id = NEW.id;
END;

CREATE TRIGGER erosions_change_bytes AFTER UPDATE OF bytes ON erosions
BEGIN
  UPDATE owner_use SET stored_bytes = stored_bytes + NEW.bytes - OLD.bytes
    WHERE owner IN (SELECT owner FROM owner_erosions WHERE erosion_id = NEW.id);
END;

CREATE TRIGGER owner_erosions_add AFTER INSERT ON owner_erosions
BEGIN
  UPDATE owner_use SET stored_bytes = stored_bytes + (SELECT bytes FROM erosions WHERE id = NEW.erosion_id)
    WHERE owner = NEW.owner;
  INSERT INTO owner_meshes (owner, sha256, erosions)
    VALUES (NEW.owner, (SELECT mesh_sha256 FROM erosions WHERE id = NEW.erosion_id), 1)
    ON CONFLICT (owner, sha256) DO UPDATE SET erosions = erosions + 1;
END;

CREATE TRIGGER owner_erosions_take AFTER DELETE ON owner_erosions
BEGIN
  UPDATE owner_use SET stored_bytes = stored_bytes - (SELECT bytes FROM erosions WHERE id = OLD.erosion_id)
    WHERE owner = OLD.owner;
  UPDATE owner_meshes SET erosions = erosions - 1
    WHERE owner = OLD.owner AND sha256 = (SELECT mesh_sha256 FROM erosions WHERE id = OLD.erosion_id);
  DELETE FROM owner_meshes WHERE erosions = 0
    AND owner = OLD.owner AND sha256 = (SELECT mesh_sha256 FROM erosions WHERE id = OLD.erosion_id);
END;

CREATE TRIGGER owner_meshes_add AFTER INSERT ON owner_meshes
BEGIN
  UPDATE owner_use SET (mesh_bytes, stored_bytes) =
    (SELECT mesh_bytes + m.bytes, stored_bytes + m.bytes FROM meshes m WHERE m.sha256 = NEW.sha256)
    WHERE owner = NEW.owner;
END;

CREATE TRIGGER owner_meshes_take AFTER DELETE ON owner_meshes
BEGIN
  UPDATE owner_use SET (mesh_bytes, stored_bytes) =
    (SELECT mesh_bytes - m.bytes, stored_bytes - m.bytes FROM meshes m WHERE m.sha256 = OLD.sha256)
    WHERE owner = OLD.owner;
END;

CREATE TRIGGER jobs_add_use AFTER INSERT ON jobs
BEGIN
  INSERT INTO owner_use (owner) VALUES (NEW.owner) ON CONFLICT (owner) DO NOTHING;
  UPDATE owner_use SET queued_jobs = queued_jobs + (NEW.state IN ('queued', 'running')) WHERE owner = NEW.owner;
  INSERT INTO owner_erosions (owner, erosion_id, jobs) VALUES (NEW.owner, NEW.erosion_id, 1)
    ON CONFLICT (owner, erosion_id) DO UPDATE SET jobs = jobs + 1;
END;

CREATE TRIGGER jobs_take_use AFTER DELETE ON jobs
BEGIN
  UPDATE owner_use SET queued_jobs = queued_jobs - (OLD.state IN ('queued', 'running')) WHERE owner = OLD.owner;
  UPDATE owner_erosions SET jobs = jobs - 1 WHERE owner = OLD.owner AND erosion_id = OLD.erosion_id;
  DELETE FROM owner_erosions WHERE owner = OLD.owner AND erosion_id = OLD.erosion_id AND jobs = 0;
END;

CREATE TRIGGER jobs_change_erosion AFTER UPDATE OF erosion_id ON jobs WHEN OLD.erosion_id <> NEW.erosion_id
BEGIN
  INSERT INTO owner_erosions (owner, erosion_id, jobs) VALUES (NEW.owner, NEW.erosion_id, 1)
    ON CONFLICT (owner, erosion_id) DO UPDATE SET jobs = jobs + 1;
  UPDATE owner_erosions SET jobs = jobs - 1 WHERE owner = OLD.owner AND erosion_id = OLD.erosion_id;
  DELETE FROM owner_erosions WHERE owner = OLD.owner AND erosion_id = OLD.erosion_id AND jobs = 0;
END;

CREATE TRIGGER jobs_change_queued AFTER UPDATE OF state ON jobs
BEGIN
  UPDATE owner_use SET queued_jobs = queued_jobs + (NEW.state IN ('queued', 'running'))
    - (OLD.state IN ('queued', 'running')) WHERE owner = NEW.owner;
END;

-- Samples of a field's directions that are computed again.
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

-- Who may call.  Of a token only its SHA-256 is kept.
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

-- What the server remembers about itself.
CREATE TABLE server_state (
  key   TEXT PRIMARY KEY,
  value TEXT NOT NULL
) STRICT, WITHOUT ROWID;
