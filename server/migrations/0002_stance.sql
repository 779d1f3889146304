-- How a job's solid stands in pictures, as numbers of AxisDirection; 0 = as its shape tells.
ALTER TABLE jobs ADD COLUMN stance_up INTEGER NOT NULL DEFAULT 0 CHECK (stance_up BETWEEN 0 AND 6);
ALTER TABLE jobs ADD COLUMN stance_front INTEGER NOT NULL DEFAULT 0
  CHECK (stance_front BETWEEN 0 AND 6 AND (stance_up = 0) = (stance_front = 0));
