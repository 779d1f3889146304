-- Schema 14: what lists of jobs tell, without a look at a page of meshes and one of tasks for each of them.

ALTER TABLE erosions ADD COLUMN mesh_bytes INTEGER NOT NULL DEFAULT 0;  -- meshes.bytes, copied
UPDATE erosions SET mesh_bytes = (SELECT bytes FROM meshes WHERE sha256 = erosions.mesh_sha256);
CREATE TRIGGER erosions_copy_mesh_bytes AFTER INSERT ON erosions
BEGIN
  UPDATE erosions SET mesh_bytes = (SELECT bytes FROM meshes WHERE sha256 = NEW.mesh_sha256) WHERE id = NEW.id;
END;

-- The few tasks for which a worker had too little memory.
CREATE INDEX tasks_in_need ON tasks (job_id) WHERE state = 'pending' AND parked = 0 AND needs_memory > 0;
