-- Between erode and derive: what the directions have found goes down to the infimum over all, see store/refinement.h.

-- What tables check may change in place, for it does not concern what is stored (sqlite.org/lang_altertable.html,
-- section 7).
PRAGMA writable_schema = ON;
UPDATE sqlite_schema SET sql = replace(sql, '''erode'', ''derive''', '''erode'', ''refine'', ''derive''')
  WHERE type = 'table' AND name = 'jobs';
UPDATE sqlite_schema SET sql = replace(replace(sql, '((kind = ''erode'') =', '((kind IN (''erode'', ''refine'')) ='),
    '(''prepare'', ''erode'')', '(''prepare'', ''erode'', ''refine'')')
  WHERE type = 'table' AND name = 'tasks';
PRAGMA writable_schema = RESET;

ALTER TABLE erosions ADD COLUMN refines INTEGER NOT NULL
  GENERATED ALWAYS AS (instr(params_key, ' minimum=infimum') > 0) VIRTUAL;
-- The round that is computed, or was the last; NULL before the stage begins.
ALTER TABLE erosions ADD COLUMN round INTEGER CHECK (round IS NULL OR refines AND round BETWEEN 0 AND 64);
-- Of its points those that are done: the sum of refined_ranges.
ALTER TABLE erosions ADD COLUMN refined_points INTEGER NOT NULL DEFAULT 0;

-- Of the kind refine: its positions are points, of this round.
ALTER TABLE tasks ADD COLUMN round INTEGER;

-- The refined field: records of 52 bytes by point, 4096 to a chunk.  Round 0 writes them, the others log what they
-- find, for neighbours see what the round before has left.
CREATE TABLE refined_chunks (
  id         INTEGER PRIMARY KEY,
  erosion_id INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  idx        INTEGER NOT NULL CHECK (idx >= 0),
  data       BLOB    NOT NULL CHECK (length(data) BETWEEN 52 AND 212992 AND length(data) % 52 = 0),
  sum        INTEGER NOT NULL,  -- checksum(erosion_id, idx, data)
  UNIQUE (erosion_id, idx)
) STRICT;

-- What a round after 0 has found and the chunks do not have: records of 56 bytes, point and record.
CREATE TABLE refined_log (
  id         INTEGER PRIMARY KEY,
  erosion_id INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  round      INTEGER NOT NULL CHECK (round >= 1),
  data       BLOB    NOT NULL CHECK (length(data) >= 56 AND length(data) % 56 = 0),
  sum        INTEGER NOT NULL   -- checksum(erosion_id, -1 - round, data)
) STRICT;
CREATE INDEX refined_log_by_round ON refined_log (erosion_id, round);

-- Points that are done in the present round: disjoint half-open ranges, none touching the next.
CREATE TABLE refined_ranges (
  erosion_id     INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  first_position INTEGER NOT NULL CHECK (first_position >= 0),
  end_position   INTEGER NOT NULL CHECK (end_position > first_position),
  PRIMARY KEY (erosion_id, first_position)
) STRICT, WITHOUT ROWID;

-- The workers that gave refined values, and how many, of all rounds.
CREATE TABLE refined_givers (
  erosion_id INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  worker     TEXT    NOT NULL,
  host       TEXT    NOT NULL,
  points     INTEGER NOT NULL,
  PRIMARY KEY (erosion_id, worker)
) STRICT, WITHOUT ROWID;

DROP TRIGGER fields_change_bytes;
CREATE TRIGGER fields_change_bytes AFTER UPDATE OF points ON erosions
BEGIN
  UPDATE erosions SET bytes = bytes + (20 + 52 * NEW.refines) * (ifnull(NEW.points, 0) - ifnull(OLD.points, 0))
    WHERE id = NEW.id;
END;
