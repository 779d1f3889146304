-- When the worker of a lease was last refused for want of room on the disk: that is no pause between its reports.

-- Lease clock.  NULL: not since the lease was granted, or since its last report.
ALTER TABLE tasks ADD COLUMN waited_ms INTEGER;
