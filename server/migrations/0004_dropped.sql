-- Schema 4: what deleted jobs leave behind is marked, and deleted piece by piece afterwards: a large field or
-- mesh at once would hold up the queue, and take room in the log that a full disk does not have.

ALTER TABLE erosions ADD COLUMN dropped INTEGER NOT NULL DEFAULT 0 CHECK (dropped IN (0, 1));
CREATE INDEX erosions_dropped ON erosions (id) WHERE dropped = 1;

-- Meshes of which some chunks may be gone already.  (A mark in meshes would be a change to a stored mesh.)
CREATE TABLE dropped_meshes (
  sha256 TEXT PRIMARY KEY REFERENCES meshes (sha256) ON DELETE CASCADE
) STRICT, WITHOUT ROWID;
