-- Schema 9: what owners use, and how long it is kept.

ALTER TABLE jobs ADD COLUMN pinned INTEGER NOT NULL DEFAULT 0 CHECK (pinned IN (0, 1));  -- retention leaves it alone
-- When retention removed its results: its erosion is then another one, of which nothing is stored.  0 = they are kept.
ALTER TABLE jobs ADD COLUMN removed_ms INTEGER NOT NULL DEFAULT 0;
-- When retention is going to remove its results or, when they are gone, the job itself.  0 = not planned.
ALTER TABLE jobs ADD COLUMN expires_ms INTEGER NOT NULL DEFAULT 0;
-- Bytes of the field, once it is known how large it becomes, and of the artefacts.
ALTER TABLE erosions ADD COLUMN bytes INTEGER NOT NULL DEFAULT 0;
UPDATE erosions SET bytes = 20 * ifnull(points, 0)
  + (SELECT ifnull(sum(bytes), 0) FROM artifacts WHERE erosion_id = erosions.id);

-- Oldest first, of an owner's jobs with and without results.
CREATE INDEX jobs_to_expire ON jobs (owner, (removed_ms > 0), finished_ms)
  WHERE pinned = 0 AND expires_ms = 0 AND finished_ms > 0;
CREATE INDEX jobs_expiring ON jobs (expires_ms) WHERE expires_ms > 0;

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

INSERT INTO owner_use (owner, queued_jobs) SELECT owner, sum(state IN ('queued', 'running')) FROM jobs GROUP BY owner;
INSERT INTO owner_erosions (owner, erosion_id, jobs) SELECT owner, erosion_id, count(*) FROM jobs GROUP BY 1, 2;
