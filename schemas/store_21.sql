-- Migration 21: where in its load step a fault begins to slide. The schema before it is store.sql,
-- store_2.sql to store_20.sql. NULL: not searched, as of results from before; then the onset is the
-- step's end.

ALTER TABLE fault_onsets ADD COLUMN load_factor_before REAL;  -- of the step: seen not to slide yet
ALTER TABLE fault_onsets ADD COLUMN load_factor_after REAL;   -- and seen to slide
ALTER TABLE fault_onsets ADD COLUMN change_before_pa REAL;    -- at load_factor_before, of change_pa's side
