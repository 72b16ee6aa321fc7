-- Migration 6: nights of `faultsweep nightly` (docs/nightly.md). The schema before it is store.sql,
-- store_2.sql to store_5.sql. Only the store of the nights has rows here; the cases of a night are
-- run in a store of their own.

CREATE TABLE nights (
  id INTEGER PRIMARY KEY,
  at REAL NOT NULL,                    -- when it began
  wall_s REAL NOT NULL,
  suite TEXT NOT NULL,                 -- its name
  environment TEXT NOT NULL,           -- fingerprint of what bits depend on
  environment_fields TEXT NOT NULL,    -- JSON object: processor, blas, compiler, ...
  baseline_environment TEXT NOT NULL,  -- fingerprint of the baseline compared with; "" = none
  program_version TEXT NOT NULL,
  numerics_version INTEGER NOT NULL,
  n_compared INTEGER NOT NULL,         -- cases with a baseline
  n_regressed INTEGER NOT NULL,
  exit_code INTEGER NOT NULL,
  blessed TEXT                         -- the reason, where the night became the baseline
) STRICT;

CREATE TABLE night_cases (
  night_id INTEGER NOT NULL REFERENCES nights (id),
  campaign TEXT NOT NULL,              -- 'faultsim verify' for verification problems
  position INTEGER NOT NULL,           -- of the case in its campaign, from 1
  identity TEXT NOT NULL,              -- of the case; the problem's name for verification
  label TEXT NOT NULL,                 -- its parameters
  verdict TEXT NOT NULL CHECK (verdict IN
    ('unblessed', 'identical', 'within tier', 'last bits', 'beyond tier', 'ranking changed',
     'activation flipped', 'outcome changed', 'missing')),
  regressed INTEGER NOT NULL,
  max_ulps REAL NOT NULL,              -- over all numbers; may pass the largest integer
  load_step INTEGER,                   -- the first that differs; NULL = none, or what follows from the steps
  place TEXT NOT NULL,                 -- of the first difference: "load step 7 (gas_storage), fault 2"
  quantity TEXT NOT NULL,              -- the one with most ulps there
  remark TEXT NOT NULL,                -- the difference in words
  digest TEXT NOT NULL,                -- of all numbers of the result; "" = no result
  wall_s REAL,
  outcome TEXT NOT NULL,
  activated_area_m2 REAL,
  moment_nm REAL,
  chi_bar REAL,
  PRIMARY KEY (night_id, campaign, identity)
) STRICT, WITHOUT ROWID;
