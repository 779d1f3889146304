-- Schema 3: records of reports that are not merged into the field's chunks yet.  Late in an erosion a report
-- improves a few points of every chunk; merging each at once would write the whole field every second.

CREATE TABLE field_log (
  id         INTEGER PRIMARY KEY,
  erosion_id INTEGER NOT NULL REFERENCES erosions (id) ON DELETE CASCADE,
  -- Records of 24 bytes: E and area (float64), direction and point (uint32), little-endian.
  data       BLOB    NOT NULL CHECK (length(data) >= 24 AND length(data) % 24 = 0)
) STRICT;
CREATE INDEX field_log_by_erosion ON field_log (erosion_id);
