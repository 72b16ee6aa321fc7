-- Migration 7: what `faultsweep tradeoff` found (docs/tradeoff.md). The schema before it is store.sql,
-- store_2.sql to store_6.sql.

CREATE TABLE tradeoffs (
  id INTEGER PRIMARY KEY,
  at REAL NOT NULL,
  source TEXT NOT NULL,                -- the scene's or spec's file
  campaign TEXT NOT NULL,              -- in this store, whose cases are the choices
  program_version TEXT NOT NULL,
  report TEXT NOT NULL                 -- JSON, as `faultsweep tradeoff --json` prints it
) STRICT;

-- How far the cases of a campaign are off at a tier: measured on a sample of them.
CREATE TABLE error_bars (
  campaign TEXT NOT NULL,              -- its name in the spec
  tier TEXT NOT NULL,
  metric TEXT NOT NULL,                -- of the whole history
  reference TEXT NOT NULL,             -- the tier that it was measured against
  n_cases INTEGER NOT NULL,
  rms REAL NOT NULL,                   -- SI
  largest REAL NOT NULL,               -- SI
  tradeoff_id INTEGER NOT NULL REFERENCES tradeoffs (id),
  PRIMARY KEY (campaign, tier, metric)
) STRICT, WITHOUT ROWID;
