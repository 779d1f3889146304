-- Logged records of a report lie apart by the part of the field that they are of: each is merged by itself, and who
-- reads the field has one part of the log in memory.

-- Chunks 32 part .. 32 part + 31.  NULL: written by an earlier server, of any chunks.
ALTER TABLE field_log ADD COLUMN part INTEGER CHECK (part >= 0);
-- In the index, so that how much is logged of a part can be told without a look at the rows.
ALTER TABLE field_log ADD COLUMN bytes INTEGER CHECK (part IS NULL OR bytes = length(data));
DROP INDEX field_log_by_erosion;
CREATE INDEX field_log_by_part ON field_log (erosion_id, part, bytes);
