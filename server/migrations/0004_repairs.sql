-- Of a job whose mesh was repaired before it was submitted: the mesh that it came of, and the report.

CREATE TABLE repairs (
  job_id        TEXT NOT NULL PRIMARY KEY REFERENCES jobs (id) ON DELETE CASCADE,
  owner         TEXT NOT NULL,  -- jobs.owner
  source_sha256 TEXT NOT NULL REFERENCES meshes (sha256),
  report        BLOB NOT NULL   -- a serialized MeshRepair
) STRICT, WITHOUT ROWID;
CREATE INDEX repairs_by_source ON repairs (source_sha256, owner);

-- A source counts to what its owner has as the meshes of his erosions do.
CREATE TRIGGER repairs_add AFTER INSERT ON repairs
BEGIN
  INSERT INTO owner_meshes (owner, sha256, erosions) VALUES (NEW.owner, NEW.source_sha256, 1)
    ON CONFLICT (owner, sha256) DO UPDATE SET erosions = erosions + 1;
END;

CREATE TRIGGER repairs_take AFTER DELETE ON repairs
BEGIN
  UPDATE owner_meshes SET erosions = erosions - 1 WHERE owner = OLD.owner AND sha256 = OLD.source_sha256;
  DELETE FROM owner_meshes WHERE erosions = 0 AND owner = OLD.owner AND sha256 = OLD.source_sha256;
  INSERT INTO dropped_meshes (sha256) SELECT OLD.source_sha256
    WHERE NOT EXISTS (SELECT 1 FROM erosions WHERE mesh_sha256 = OLD.source_sha256)
    AND NOT EXISTS (SELECT 1 FROM repairs WHERE source_sha256 = OLD.source_sha256);
END;
