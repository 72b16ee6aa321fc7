-- Migration 3: slip events and activation episodes. The schema before it is store.sql, store_2.sql.
-- Slip events are jumps of a fault's equilibrium within a case (docs/model.md, "Slip events"). They
-- are in slip_events; the table `events` is the log of the campaigns.
-- Runs while foreign keys are off: tables whose CHECKs change are made anew (migrations.cc).

DROP VIEW ranking;
DROP VIEW stage_ranking;
DROP VIEW chi_history_wide;
DROP VIEW failures;
DROP VIEW campaign_progress;
DROP VIEW campaign_case_states;

-- runs: outcomes event and unresolved_event.
CREATE TABLE runs_3 (
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
  outcome TEXT CHECK (outcome IN ('failed', 'converged', 'event', 'unresolved_event', 'unconverged',
    'unstable', 'interrupted')),
  reason TEXT NOT NULL,                -- "" when complete
  signal INTEGER,                      -- of the simulator process
  exit_code INTEGER,
  log_tail TEXT NOT NULL,
  operator TEXT,
  numerics_version INTEGER,
  fields_only INTEGER NOT NULL DEFAULT 0,  -- 1: of a case that had its result already
  CHECK ((status = 'completed') = (outcome IS NOT NULL)),
  UNIQUE (case_id, attempt)
) STRICT;
INSERT INTO runs_3 (id, case_id, campaign_id, attempt, ended_at, wall_s, host, rank, status,
                    outcome, reason, signal, exit_code, log_tail, operator, numerics_version,
                    fields_only)
  SELECT id, case_id, campaign_id, attempt, ended_at, wall_s, host, rank, status, outcome, reason,
         signal, exit_code, log_tail, operator, numerics_version, fields_only FROM runs;
DROP TABLE runs;
ALTER TABLE runs_3 RENAME TO runs;

-- What rankings read. rank_class: 0 complete history (converged or event), 1 complete, but the size
-- of its events is the mesh's (unresolved_event), 2 unstable, 3 any other early end.
CREATE TABLE stage_metrics_3 (
  stage_id INTEGER NOT NULL REFERENCES names (id),
  case_id INTEGER NOT NULL REFERENCES cases (id),
  rank_class INTEGER NOT NULL CHECK (rank_class IN (0, 1, 2, 3)),
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
  n_events INTEGER NOT NULL,
  event_moment_nm REAL NOT NULL,       -- of the largest event
  event_magnitude_mw REAL,
  pressure_margin_pa REAL,             -- of the case, repeated so that the default order is one index
  first_step INTEGER NOT NULL,
  last_step INTEGER NOT NULL,
  PRIMARY KEY (stage_id, case_id)
) STRICT, WITHOUT ROWID;
-- Earlier simulators followed no events, so there are none to count.
INSERT INTO stage_metrics_3
  SELECT stage_id, case_id, CASE rank_class WHEN 0 THEN 0 ELSE rank_class + 1 END, activated,
         activation_step, activation_pressure_pa, activated_fault_id, chi_bar, chi_max,
         area_chi_080_m2, thickness_chi_080_m, activated_area_m2, slipping_area_m2, open_area_m2,
         max_slip_m, potency_m3, moment_nm, magnitude_mw, 0, 0, NULL, pressure_margin_pa,
         first_step, last_step FROM stage_metrics;
DROP TABLE stage_metrics;
ALTER TABLE stage_metrics_3 RENAME TO stage_metrics;
CREATE INDEX stage_metrics_default_order ON stage_metrics
  (stage_id, rank_class, activated_area_m2 DESC, moment_nm DESC,
   (coalesce(pressure_margin_pa, 9e99)), chi_bar DESC, case_id);

-- NULL in the columns that follow: stored before this migration, not known.
ALTER TABLE case_metrics ADD COLUMN unexpected INTEGER;  -- reactivation as pressure recovers
ALTER TABLE case_metrics ADD COLUMN n_episodes INTEGER;
ALTER TABLE case_metrics ADD COLUMN max_penetration_m REAL;
ALTER TABLE chi_history ADD COLUMN activated_at_edge INTEGER;

-- Jumps of equilibrium that were followed to the next one, with their evidence.
CREATE TABLE slip_events (
  case_id INTEGER NOT NULL REFERENCES cases (id),
  number INTEGER NOT NULL,             -- from 1, in order of time
  step INTEGER NOT NULL,
  stage_id INTEGER NOT NULL REFERENCES names (id),
  load_factor_before REAL NOT NULL,    -- of the load step: the last equilibrium
  load_factor_after REAL NOT NULL,     -- where the jump was followed
  time_s REAL NOT NULL,                -- of onset, on the clock of the load history
  pressure_change_pa REAL NOT NULL,    -- of the most depleted region at onset
  fault_id INTEGER REFERENCES names (id),  -- where it nucleated
  depth_m REAL NOT NULL,               -- of the centre of the nucleus
  nucleation_length_m REAL NOT NULL,   -- down dip
  slipped_area_m2 REAL NOT NULL,       -- plane strain: this and the like per metre of strike
  max_slip_m REAL NOT NULL,
  mean_slip_m REAL NOT NULL,
  stress_drop_pa REAL NOT NULL,
  potency_m3 REAL NOT NULL,
  moment_nm REAL NOT NULL,
  magnitude_mw REAL,                   -- none in plane strain
  duration_s REAL NOT NULL,            -- of the radiation-damped motion
  resolved INTEGER NOT NULL,           -- 0: cells too coarse, its size is the mesh's
  negative_pivots INTEGER NOT NULL,
  n_lost_cohesion INTEGER NOT NULL,
  residual_before REAL NOT NULL,       -- in units of the tolerance
  residual_after REAL NOT NULL,
  energy_released_j REAL NOT NULL,
  energy_dissipated_j REAL NOT NULL,
  evidence_holds INTEGER NOT NULL,
  PRIMARY KEY (case_id, number)
) STRICT, WITHOUT ROWID;

-- Runs of load steps of one stage in which a fault slips far enough to count as activated.
CREATE TABLE episodes (
  case_id INTEGER NOT NULL REFERENCES cases (id),
  number INTEGER NOT NULL,             -- from 1, in order of time
  stage_id INTEGER NOT NULL REFERENCES names (id),
  fault_id INTEGER NOT NULL REFERENCES names (id),
  first_step INTEGER NOT NULL,
  last_step INTEGER NOT NULL,
  pressure_change_pa REAL NOT NULL,    -- of the most depleted region at the first step
  after_recovery INTEGER NOT NULL,     -- pressure had been lower before
  activated_area_m2 REAL NOT NULL,
  max_slip_m REAL NOT NULL,
  moment_nm REAL NOT NULL,
  magnitude_mw REAL,
  PRIMARY KEY (case_id, number)
) STRICT, WITHOUT ROWID;

-- For sqlite3, Datasette and pandas ---------------------------------------------------------------

CREATE VIEW ranking AS
SELECT k.name AS campaign, cc.position AS "case", c.identity, cc.parameter_labels,
       m.outcome, s.rank_class, s.activated, f.name AS activated_fault, s.activation_step,
       s.activation_pressure_pa, s.activated_area_m2, s.moment_nm, s.magnitude_mw, s.n_events,
       s.event_moment_nm, s.event_magnitude_mw, m.n_episodes, m.unexpected, s.chi_bar,
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
       s.moment_nm, s.magnitude_mw, s.n_events, s.event_moment_nm, s.event_magnitude_mw, s.chi_bar,
       s.chi_max, s.area_chi_080_m2, s.thickness_chi_080_m, s.slipping_area_m2, s.open_area_m2,
       s.max_slip_m, s.potency_m3, s.first_step, s.last_step
FROM stage_metrics s
JOIN names n ON n.id = s.stage_id
JOIN case_metrics m ON m.case_id = s.case_id
JOIN campaign_cases cc ON cc.case_id = s.case_id
JOIN campaigns k ON k.id = cc.campaign_id
LEFT JOIN names f ON f.id = s.activated_fault_id;

-- One row per slip event of each case, with the case's parameters.
CREATE VIEW case_events AS
SELECT k.name AS campaign, cc.position AS "case", cc.parameter_labels, m.outcome,
       e.number AS event, e.step, g.name AS stage, e.time_s, e.pressure_change_pa, f.name AS fault,
       e.depth_m, e.nucleation_length_m, e.slipped_area_m2, e.max_slip_m, e.mean_slip_m,
       e.stress_drop_pa, e.potency_m3, e.moment_nm, e.magnitude_mw, e.duration_s, e.resolved,
       e.energy_released_j, e.energy_dissipated_j, e.evidence_holds, m.plane_strain
FROM slip_events e
JOIN names g ON g.id = e.stage_id
LEFT JOIN names f ON f.id = e.fault_id
JOIN case_metrics m ON m.case_id = e.case_id
JOIN campaign_cases cc ON cc.case_id = e.case_id
JOIN campaigns k ON k.id = cc.campaign_id;

CREATE VIEW case_episodes AS
SELECT k.name AS campaign, cc.position AS "case", cc.parameter_labels, m.outcome, m.unexpected,
       e.number AS episode, g.name AS stage, f.name AS fault, e.first_step, e.last_step,
       e.pressure_change_pa, e.after_recovery, e.activated_area_m2, e.max_slip_m, e.moment_nm,
       e.magnitude_mw, m.plane_strain
FROM episodes e
JOIN names g ON g.id = e.stage_id
JOIN names f ON f.id = e.fault_id
JOIN case_metrics m ON m.case_id = e.case_id
JOIN campaign_cases cc ON cc.case_id = e.case_id
JOIN campaigns k ON k.id = cc.campaign_id;

CREATE VIEW chi_history_wide AS
SELECT k.name AS campaign, cc.position AS "case", h.step, g.name AS stage, l.time_s,
       l.pressure_change_pa, f.name AS fault, h.chi_bar, h.chi_max, h.chi_static_max,
       h.area_chi_080_m2, h.thickness_chi_080_max_m, h.thickness_chi_080_mean_m, h.slipping_area_m2,
       h.open_area_m2, h.activated_area_m2, h.activated_length_m, h.activated, h.activated_at_edge,
       h.max_slip_m, h.mean_slip_m, h.potency_m3, h.moment_nm, h.moment_step_nm
FROM chi_history h
JOIN load_steps l ON l.case_id = h.case_id AND l.step = h.step
JOIN names g ON g.id = l.stage_id
JOIN names f ON f.id = h.fault_id
JOIN campaign_cases cc ON cc.case_id = h.case_id
JOIN campaigns k ON k.id = cc.campaign_id;

-- As in store_2.sql, and whether the case's history is complete.
CREATE VIEW campaign_case_states AS
SELECT cc.campaign_id, cc.position, cc.case_id, c.family_id, c.run_id, c.outcome, cc.fields,
       CASE WHEN c.state <> 'done' OR cc.fields = 'none' OR cc.fields = 'kept' THEN c.state
            WHEN cc.fields = 'wanted' THEN 'waiting'
            ELSE 'failed' END AS state,
       CASE WHEN cc.fields = 'none' OR cc.fields = 'kept' THEN 0
            ELSE c.state = 'done' END AS lacks_only_fields,
       coalesce(c.outcome IN ('converged', 'event', 'unresolved_event'), 0) AS complete
FROM campaign_cases cc
JOIN cases c ON c.id = cc.case_id;

CREATE VIEW campaign_progress AS
SELECT k.name AS campaign, k.state, count(*) AS cases, sum(s.state = 'done') AS done,
       sum(s.state = 'done' AND s.outcome = 'converged') AS converged,
       sum(s.state = 'done' AND s.outcome = 'event') AS with_events,
       sum(s.state = 'done' AND s.outcome = 'unresolved_event') AS with_unresolved_events,
       sum(s.state = 'failed') AS failed, sum(s.state = 'waiting') AS waiting
FROM campaigns k
JOIN campaign_case_states s ON s.campaign_id = k.id
GROUP BY k.id;

CREATE VIEW failures AS
SELECT k.name AS campaign, s.position AS "case", r.attempt, r.status, r.outcome, r.reason,
       r.signal, r.exit_code, r.log_tail, s.state, r.fields_only
FROM runs r
JOIN campaign_case_states s ON s.case_id = r.case_id
JOIN campaigns k ON k.id = s.campaign_id
WHERE (r.status <> 'completed' OR r.outcome NOT IN ('converged', 'event', 'unresolved_event'))
  AND (r.fields_only = 0 OR r.campaign_id = s.campaign_id);
