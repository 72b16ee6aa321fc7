-- Migration 17: how far the onset of events is off on an interpolated operator. The schema before it
-- is store.sql, store_2.sql to store_16.sql. Of results stored before it is not known.

-- Largest relative error of the weakening at which a fault becomes unstable; NULL: not measured.
ALTER TABLE case_surfaces ADD COLUMN error_of_stability REAL;
