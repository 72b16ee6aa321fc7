-- The store of faultsweep as created: campaign.sqlite, user_version 1.
-- Later changes are the named migrations in campaign/store/migrations.cc: store_2.sql to
-- store_8.sql.
-- Units are part of column names; times are seconds since 1970 (_at) or durations (_s).

CREATE TABLE migrations (
  version INTEGER PRIMARY KEY,
  name TEXT NOT NULL,
  applied_at REAL NOT NULL
) STRICT;

-- A base scene; a case is a base scene with some values changed.
CREATE TABLE scenes (
  id INTEGER PRIMARY KEY,
  hash TEXT NOT NULL UNIQUE,           -- of source and document
  source TEXT NOT NULL,                -- file that relative paths in the document start from
  document TEXT NOT NULL               -- JSON
) STRICT;

-- A submitted spec, kept three times: as given, resolved, expanded. The expanded copy is one row of
-- campaign_cases per case (base scene's hash and parameter vector); its hash covers all of them.
CREATE TABLE campaigns (
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  submitted_at REAL NOT NULL,
  state TEXT NOT NULL DEFAULT 'open' CHECK (state IN ('open', 'cancelled')),
  source TEXT NOT NULL,                -- file the spec was read from
  spec_given TEXT NOT NULL,
  spec_given_hash TEXT NOT NULL,
  spec_resolved TEXT NOT NULL,
  spec_resolved_hash TEXT NOT NULL,
  spec_expanded_hash TEXT NOT NULL,
  parameters TEXT NOT NULL,            -- JSON array of {name, dimension}, see campaign_cases
  rank_by TEXT NOT NULL,               -- expression
  n_excluded INTEGER NOT NULL,
  n_merged INTEGER NOT NULL,
  on_failure TEXT NOT NULL CHECK (on_failure IN ('abort', 'retry', 'continue')),
  retries INTEGER NOT NULL CHECK (retries >= 0),
  case_time_limit_s REAL,
  case_memory_limit_bytes INTEGER
) STRICT;

-- Cases that share mesh, boundary conditions and bulk stiffness, hence one fault operator.
CREATE TABLE families (
  id INTEGER PRIMARY KEY,
  fingerprint TEXT NOT NULL UNIQUE,
  predicted_unknowns INTEGER NOT NULL,
  predicted_jump_unknowns INTEGER NOT NULL,
  predicted_operator_s REAL NOT NULL,
  predicted_memory_bytes REAL NOT NULL,
  operator TEXT                        -- fingerprint in operators, once known
) STRICT;

CREATE TABLE operators (
  fingerprint TEXT PRIMARY KEY,
  unknowns INTEGER NOT NULL,
  jump_unknowns INTEGER NOT NULL,
  bytes INTEGER NOT NULL,
  peak_bytes INTEGER NOT NULL,
  build_s REAL,                        -- of the last build; null when only found in the cache
  times_built INTEGER NOT NULL,
  times_found INTEGER NOT NULL,
  last_used_at REAL NOT NULL
) STRICT, WITHOUT ROWID;

-- One scene, whatever campaigns ask for it.
CREATE TABLE cases (
  id INTEGER PRIMARY KEY,
  identity TEXT NOT NULL UNIQUE,
  family_id INTEGER NOT NULL REFERENCES families (id),
  scene_id INTEGER NOT NULL REFERENCES scenes (id),
  changes TEXT NOT NULL,               -- JSON object: pointer -> value, applied to the base scene
  state TEXT NOT NULL DEFAULT 'waiting' CHECK (state IN ('waiting', 'done', 'failed')),
  outcome TEXT,                        -- of the run that decided the state, when it was completed
  run_id INTEGER                       -- the run that decided the state
) STRICT;
CREATE INDEX cases_of_family ON cases (family_id);

CREATE TABLE campaign_cases (
  campaign_id INTEGER NOT NULL REFERENCES campaigns (id),
  position INTEGER NOT NULL,           -- the case's number in its campaign, from 1
  case_id INTEGER NOT NULL REFERENCES cases (id),
  parameter_values TEXT NOT NULL,      -- JSON array in the order of campaigns.parameters: SI or words
  parameter_labels TEXT NOT NULL,      -- the same with the units given
  PRIMARY KEY (campaign_id, position)
) STRICT, WITHOUT ROWID;
CREATE UNIQUE INDEX campaigns_of_case ON campaign_cases (case_id, campaign_id);

-- One attempt at a case; never overwritten.
CREATE TABLE runs (
  id INTEGER PRIMARY KEY,
  case_id INTEGER NOT NULL REFERENCES cases (id),
  campaign_id INTEGER NOT NULL REFERENCES campaigns (id),
  attempt INTEGER NOT NULL,
  ended_at REAL NOT NULL,
  wall_s REAL NOT NULL,
  host TEXT NOT NULL,
  rank INTEGER NOT NULL,
  status TEXT NOT NULL CHECK (status IN
    ('completed', 'refused', 'crashed', 'hung', 'garbled', 'memory', 'world', 'bug')),
  outcome TEXT CHECK (outcome IN ('failed', 'converged', 'unconverged', 'unstable', 'interrupted')),
  reason TEXT NOT NULL,                -- "" when converged
  signal INTEGER,                      -- of the simulator process
  exit_code INTEGER,
  log_tail TEXT NOT NULL,
  operator TEXT,
  numerics_version INTEGER,
  CHECK ((status = 'completed') = (outcome IS NOT NULL)),
  UNIQUE (case_id, attempt)
) STRICT;

-- Names of stages and faults; "" is the whole case.
CREATE TABLE names (
  id INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE
) STRICT;

-- Of the run that decided the case.
CREATE TABLE case_metrics (
  case_id INTEGER PRIMARY KEY REFERENCES cases (id),
  run_id INTEGER NOT NULL REFERENCES runs (id),
  outcome TEXT NOT NULL,
  reason TEXT NOT NULL,
  n_steps INTEGER NOT NULL,
  failed_step INTEGER,
  plane_strain INTEGER NOT NULL,
  weakening_resolved INTEGER NOT NULL,
  max_nucleation_ratio REAL,
  pressure_margin_pa REAL,
  newton_iterations INTEGER NOT NULL,
  active_set_passes INTEGER NOT NULL,
  sub_steps INTEGER NOT NULL,
  wasted_newton_iterations INTEGER NOT NULL,
  warnings TEXT NOT NULL               -- one per line
) STRICT;

-- What rankings read. rank_class: 0 complete history, 1 unstable, 2 any other early end; since
-- store_3.sql the early ends are 2 and 3.
CREATE TABLE stage_metrics (
  stage_id INTEGER NOT NULL REFERENCES names (id),
  case_id INTEGER NOT NULL REFERENCES cases (id),
  rank_class INTEGER NOT NULL CHECK (rank_class IN (0, 1, 2)),
  activated INTEGER NOT NULL,
  activation_step INTEGER,
  activation_pressure_pa REAL,
  activated_fault_id INTEGER REFERENCES names (id),
  chi_bar REAL NOT NULL,
  chi_max REAL NOT NULL,
  area_chi_080_m2 REAL NOT NULL,
  thickness_chi_080_m REAL NOT NULL,
  activated_area_m2 REAL NOT NULL,
  slipping_area_m2 REAL NOT NULL,
  open_area_m2 REAL NOT NULL,
  max_slip_m REAL NOT NULL,
  potency_m3 REAL NOT NULL,
  moment_nm REAL NOT NULL,
  magnitude_mw REAL,
  pressure_margin_pa REAL,             -- of the case, repeated so that the default order is one index
  first_step INTEGER NOT NULL,
  last_step INTEGER NOT NULL,
  PRIMARY KEY (stage_id, case_id)
) STRICT, WITHOUT ROWID;
CREATE INDEX stage_metrics_default_order ON stage_metrics
  (stage_id, rank_class, activated_area_m2 DESC, moment_nm DESC,
   (coalesce(pressure_margin_pa, 9e99)), chi_bar DESC, case_id);

CREATE TABLE load_steps (
  case_id INTEGER NOT NULL REFERENCES cases (id),
  step INTEGER NOT NULL,
  stage_id INTEGER NOT NULL REFERENCES names (id),
  time_s REAL NOT NULL,
  pressure_change_pa TEXT NOT NULL,    -- JSON array, per region
  outcome TEXT NOT NULL,
  reason TEXT NOT NULL,
  n_stick INTEGER NOT NULL,
  n_slip INTEGER NOT NULL,
  n_open INTEGER NOT NULL,
  newton_iterations INTEGER NOT NULL,
  active_set_passes INTEGER NOT NULL,
  PRIMARY KEY (case_id, step)
) STRICT, WITHOUT ROWID;

CREATE TABLE chi_history (
  case_id INTEGER NOT NULL REFERENCES cases (id),
  fault INTEGER NOT NULL,              -- position of the fault in the scene, from 0
  step INTEGER NOT NULL,
  fault_id INTEGER NOT NULL REFERENCES names (id),
  chi_bar REAL NOT NULL,
  chi_max REAL NOT NULL,
  chi_static_max REAL NOT NULL,
  area_chi_080_m2 REAL NOT NULL,
  thickness_chi_080_max_m REAL NOT NULL,
  thickness_chi_080_mean_m REAL NOT NULL,
  slipping_area_m2 REAL NOT NULL,
  open_area_m2 REAL NOT NULL,
  activated_area_m2 REAL NOT NULL,
  activated_length_m REAL NOT NULL,
  activated INTEGER NOT NULL,
  max_slip_m REAL NOT NULL,
  mean_slip_m REAL NOT NULL,
  potency_m3 REAL NOT NULL,
  moment_nm REAL NOT NULL,
  moment_step_nm REAL NOT NULL,
  PRIMARY KEY (case_id, fault, step)
) STRICT, WITHOUT ROWID;

-- The log of the campaigns: managers, restarts, operators, poison cases. Slip events, the jumps of
-- faults within a case, are something else: slip_events in store_3.sql.
CREATE TABLE events (
  id INTEGER PRIMARY KEY,
  at REAL NOT NULL,
  campaign_id INTEGER REFERENCES campaigns (id),
  kind TEXT NOT NULL,
  text TEXT NOT NULL
) STRICT;

-- The one manager of this store, while it lives.
CREATE TABLE owner (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  host TEXT NOT NULL,
  pid INTEGER NOT NULL,
  pid_started INTEGER NOT NULL,        -- field 22 of /proc/PID/stat: a reused pid differs here
  heartbeat_at REAL NOT NULL,
  campaign_id INTEGER REFERENCES campaigns (id),
  n_workers INTEGER NOT NULL,
  progress TEXT NOT NULL               -- JSON for faultsweep status
) STRICT;

-- For sqlite3, Datasette and pandas ---------------------------------------------------------------

CREATE VIEW ranking AS
SELECT k.name AS campaign, cc.position AS "case", c.identity, cc.parameter_labels,
       m.outcome, s.activated, f.name AS activated_fault, s.activation_step,
       s.activation_pressure_pa, s.activated_area_m2, s.moment_nm, s.magnitude_mw, s.chi_bar,
       s.chi_max, s.area_chi_080_m2, s.thickness_chi_080_m, s.slipping_area_m2, s.open_area_m2,
       s.max_slip_m, s.potency_m3, m.pressure_margin_pa, m.weakening_resolved, m.plane_strain
FROM stage_metrics s
JOIN names n ON n.id = s.stage_id AND n.name = ''
JOIN cases c ON c.id = s.case_id
JOIN case_metrics m ON m.case_id = s.case_id
JOIN campaign_cases cc ON cc.case_id = s.case_id
JOIN campaigns k ON k.id = cc.campaign_id
LEFT JOIN names f ON f.id = s.activated_fault_id
ORDER BY k.id, s.rank_class, s.activated_area_m2 DESC, s.moment_nm DESC,
         coalesce(s.pressure_margin_pa, 9e99), s.chi_bar DESC, cc.position;

CREATE VIEW stage_ranking AS
SELECT k.name AS campaign, cc.position AS "case", n.name AS stage, m.outcome, s.activated,
       f.name AS activated_fault, s.activation_step, s.activation_pressure_pa, s.activated_area_m2,
       s.moment_nm, s.magnitude_mw, s.chi_bar, s.chi_max, s.area_chi_080_m2, s.thickness_chi_080_m,
       s.slipping_area_m2, s.open_area_m2, s.max_slip_m, s.potency_m3, s.first_step, s.last_step
FROM stage_metrics s
JOIN names n ON n.id = s.stage_id
JOIN case_metrics m ON m.case_id = s.case_id
JOIN campaign_cases cc ON cc.case_id = s.case_id
JOIN campaigns k ON k.id = cc.campaign_id
LEFT JOIN names f ON f.id = s.activated_fault_id;

CREATE VIEW chi_history_wide AS
SELECT k.name AS campaign, cc.position AS "case", h.step, g.name AS stage, l.time_s,
       l.pressure_change_pa, f.name AS fault, h.chi_bar, h.chi_max, h.chi_static_max,
       h.area_chi_080_m2, h.thickness_chi_080_max_m, h.thickness_chi_080_mean_m, h.slipping_area_m2,
       h.open_area_m2, h.activated_area_m2, h.activated_length_m, h.activated, h.max_slip_m,
       h.mean_slip_m, h.potency_m3, h.moment_nm, h.moment_step_nm
FROM chi_history h
JOIN load_steps l ON l.case_id = h.case_id AND l.step = h.step
JOIN names g ON g.id = l.stage_id
JOIN names f ON f.id = h.fault_id
JOIN campaign_cases cc ON cc.case_id = h.case_id
JOIN campaigns k ON k.id = cc.campaign_id;

CREATE VIEW failures AS
SELECT k.name AS campaign, cc.position AS "case", r.attempt, r.status, r.outcome, r.reason,
       r.signal, r.exit_code, r.log_tail, c.state
FROM runs r
JOIN cases c ON c.id = r.case_id
JOIN campaign_cases cc ON cc.case_id = r.case_id
JOIN campaigns k ON k.id = cc.campaign_id
WHERE r.status <> 'completed' OR r.outcome <> 'converged';

CREATE VIEW campaign_progress AS
SELECT k.name AS campaign, k.state, count(*) AS cases, sum(c.state = 'done') AS done,
       sum(c.state = 'failed') AS failed, sum(c.state = 'waiting') AS waiting
FROM campaigns k
JOIN campaign_cases cc ON cc.campaign_id = k.id
JOIN cases c ON c.id = cc.case_id
GROUP BY k.id;
