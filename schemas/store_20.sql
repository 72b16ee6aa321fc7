-- Migration 20: how much of what a flow result does is assumed, and temperatures. The schema before it is
-- store.sql, store_2.sql to store_19.sql. Of results stored before it is not known.

-- Share of the integral of the change over the compartments that lies beyond what the flow result
-- covers; NULL without one.
ALTER TABLE case_metrics ADD COLUMN field_assumed REAL;

-- JSON array, per region, K; NULL where no temperature changes.
ALTER TABLE load_steps ADD COLUMN temperature_change_k TEXT;
