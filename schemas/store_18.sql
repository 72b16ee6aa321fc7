-- Migration 18: how far cases on an interpolated operator are off those on exact ones. The schema
-- before it is store.sql, store_2.sql to store_17.sql. Of results stored before it there were none.

ALTER TABLE case_surfaces ADD COLUMN cases INTEGER NOT NULL DEFAULT 0;  -- run on both
-- NULL without cases:
ALTER TABLE case_surfaces ADD COLUMN tolerance_of_chi_bar REAL;   -- that was asked for
ALTER TABLE case_surfaces ADD COLUMN error_of_chi_bar REAL;       -- of a fault at a load step
ALTER TABLE case_surfaces ADD COLUMN error_of_largest_slip REAL;  -- relative to the case's
ALTER TABLE case_surfaces ADD COLUMN flags_that_differ INTEGER;   -- of sliding in a stage
