-- Migration 9: metrics per fault, pressures of the faults, opening, magnitudes of events only
-- (docs/words.md). The schema before it is store.sql, store_2.sql to store_8.sql.

DROP VIEW ranking;
DROP VIEW stage_ranking;
DROP VIEW case_events;
DROP VIEW case_episodes;
DROP VIEW chi_history_wide;

-- Pressures were those of the most depleted region of the scene, wherever it was: they are dropped,
-- and those of the faults are not known of results stored before.
ALTER TABLE stage_metrics DROP COLUMN activation_pressure_pa;
ALTER TABLE slip_events DROP COLUMN pressure_change_pa;
ALTER TABLE episodes DROP COLUMN pressure_change_pa;
-- Slow slip has no magnitude.
ALTER TABLE stage_metrics RENAME COLUMN magnitude_mw TO magnitude_if_released_at_once_mw;
ALTER TABLE episodes RENAME COLUMN magnitude_mw TO magnitude_if_released_at_once_mw;

ALTER TABLE stage_metrics ADD COLUMN opening_step INTEGER;  -- first step with an open node
ALTER TABLE stage_metrics ADD COLUMN opened_fault_id INTEGER REFERENCES names (id);
-- What only opens comes before what does nothing.
DROP INDEX stage_metrics_default_order;
CREATE INDEX stage_metrics_default_order ON stage_metrics
  (stage_id, rank_class, activated_area_m2 DESC, open_area_m2 DESC, moment_nm DESC,
   (coalesce(pressure_margin_pa, 9e99)), chi_bar DESC, case_id);
-- To see at once whether a campaign mixes plane strain and 3D.
CREATE INDEX case_metrics_plane_strain ON case_metrics (plane_strain);

-- Regions on the minus and plus side of the fault, their pressure changes, and their absolute
-- pressures at the depth beside (depth_m).
ALTER TABLE slip_events ADD COLUMN region_minus_id INTEGER REFERENCES names (id);
ALTER TABLE slip_events ADD COLUMN region_plus_id INTEGER REFERENCES names (id);
ALTER TABLE slip_events ADD COLUMN change_minus_pa REAL;
ALTER TABLE slip_events ADD COLUMN change_plus_pa REAL;
ALTER TABLE slip_events ADD COLUMN absolute_minus_pa REAL;
ALTER TABLE slip_events ADD COLUMN absolute_plus_pa REAL;
ALTER TABLE slip_events ADD COLUMN change_in_fault_pa REAL;  -- of the fluid in the fault itself
ALTER TABLE episodes ADD COLUMN depth_m REAL;
ALTER TABLE episodes ADD COLUMN region_minus_id INTEGER REFERENCES names (id);
ALTER TABLE episodes ADD COLUMN region_plus_id INTEGER REFERENCES names (id);
ALTER TABLE episodes ADD COLUMN change_minus_pa REAL;
ALTER TABLE episodes ADD COLUMN change_plus_pa REAL;
ALTER TABLE episodes ADD COLUMN absolute_minus_pa REAL;
ALTER TABLE episodes ADD COLUMN absolute_plus_pa REAL;
ALTER TABLE episodes ADD COLUMN change_in_fault_pa REAL;

-- An unexpected reactivation is one of the same fault, and has its evidence: numbers of the episode
-- after the recovery of pressure and of the last one before. NULL: none.
ALTER TABLE case_metrics ADD COLUMN unexpected_episode INTEGER;
ALTER TABLE case_metrics ADD COLUMN unexpected_after INTEGER;
UPDATE case_metrics SET unexpected_episode =
  (SELECT min(e.number) FROM episodes e JOIN episodes b ON b.case_id = e.case_id
   AND b.fault_id = e.fault_id AND b.number < e.number AND NOT b.after_recovery
   WHERE e.case_id = case_metrics.case_id AND e.after_recovery)
  WHERE unexpected;
UPDATE case_metrics SET unexpected_after =
  (SELECT max(b.number) FROM episodes e JOIN episodes b ON b.case_id = e.case_id
   AND b.fault_id = e.fault_id AND b.number < e.number AND NOT b.after_recovery
   WHERE e.case_id = case_metrics.case_id AND e.number = case_metrics.unexpected_episode)
  WHERE unexpected_episode IS NOT NULL;
ALTER TABLE case_metrics DROP COLUMN unexpected;

-- What rankings of one fault read. It slips where max_slip_m > 0 and opens where open_area_m2 > 0;
-- activated: it slides. Values as in stage_metrics; results stored before have no rows here.
CREATE TABLE fault_metrics (
  stage_id INTEGER NOT NULL REFERENCES names (id),
  fault_id INTEGER NOT NULL REFERENCES names (id),
  case_id INTEGER NOT NULL REFERENCES cases (id),
  fault INTEGER NOT NULL,              -- position of the fault in the scene, from 0
  rank_class INTEGER NOT NULL,         -- of the case, repeated so that a ranking reads one table
  activated INTEGER NOT NULL,
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
  n_events INTEGER NOT NULL,           -- that nucleated on it
  event_moment_nm REAL NOT NULL,
  event_magnitude_mw REAL,
  PRIMARY KEY (stage_id, fault_id, case_id)
) STRICT, WITHOUT ROWID;

-- Where and when a fault first slides (opening 0) or opens (1) in a stage.
CREATE TABLE fault_onsets (
  case_id INTEGER NOT NULL REFERENCES cases (id),
  stage_id INTEGER NOT NULL REFERENCES names (id),
  opening INTEGER NOT NULL CHECK (opening IN (0, 1)),
  fault_id INTEGER NOT NULL REFERENCES names (id),
  step INTEGER NOT NULL,
  depth_m REAL NOT NULL,               -- of the place; datum of the absolute pressures
  region_minus_id INTEGER REFERENCES names (id),
  region_plus_id INTEGER REFERENCES names (id),
  change_minus_pa REAL,
  change_plus_pa REAL,
  absolute_minus_pa REAL,
  absolute_plus_pa REAL,
  change_in_fault_pa REAL NOT NULL,    -- of the fluid in the fault itself
  PRIMARY KEY (case_id, stage_id, opening, fault_id)
) STRICT, WITHOUT ROWID;

-- The same with the pressure of the side that changed more.
CREATE VIEW leading_onsets AS
SELECT o.*,
       CASE WHEN coalesce(abs(change_plus_pa) > coalesce(abs(change_minus_pa), -1), 0)
            THEN change_plus_pa ELSE change_minus_pa END AS change_pa,
       CASE WHEN coalesce(abs(change_plus_pa) > coalesce(abs(change_minus_pa), -1), 0)
            THEN absolute_plus_pa ELSE absolute_minus_pa END AS absolute_pa
FROM fault_onsets o;

-- For sqlite3, Datasette and pandas ---------------------------------------------------------------
-- What is per metre of strike in plane strain is in a column of its own, ..._per_m: of the two one
-- is NULL.

CREATE VIEW ranking AS
SELECT k.name AS campaign, cc.position AS "case", c.identity, cc.parameter_labels,
       m.outcome, s.rank_class, m.plane_strain, s.max_slip_m > 0 AS slips, s.activated,
       s.open_area_m2 > 0 AS opens, s.n_events > 0 AS jumps,
       f.name AS activated_fault, s.activation_step, a.depth_m AS activation_depth_m,
       a.change_pa AS activation_pressure_change_pa,
       a.absolute_pa AS activation_pressure_absolute_pa,
       fo.name AS opened_fault, s.opening_step, o.depth_m AS opening_depth_m,
       o.change_pa AS opening_pressure_change_pa, o.absolute_pa AS opening_pressure_absolute_pa,
       iif(m.plane_strain, NULL, s.activated_area_m2) AS activated_area_m2,
       iif(m.plane_strain, s.activated_area_m2, NULL) AS activated_area_m2_per_m,
       iif(m.plane_strain, NULL, s.moment_nm) AS moment_nm,
       iif(m.plane_strain, s.moment_nm, NULL) AS moment_nm_per_m,
       s.magnitude_if_released_at_once_mw, s.n_events,
       iif(m.plane_strain, NULL, s.event_moment_nm) AS event_moment_nm,
       iif(m.plane_strain, s.event_moment_nm, NULL) AS event_moment_nm_per_m,
       s.event_magnitude_mw, m.n_episodes, m.unexpected_episode IS NOT NULL AS unexpected,
       m.unexpected_episode, m.unexpected_after, s.chi_bar, s.chi_max,
       iif(m.plane_strain, NULL, s.area_chi_080_m2) AS area_chi_080_m2,
       iif(m.plane_strain, s.area_chi_080_m2, NULL) AS area_chi_080_m2_per_m,
       s.thickness_chi_080_m,
       iif(m.plane_strain, NULL, s.slipping_area_m2) AS slipping_area_m2,
       iif(m.plane_strain, s.slipping_area_m2, NULL) AS slipping_area_m2_per_m,
       iif(m.plane_strain, NULL, s.open_area_m2) AS open_area_m2,
       iif(m.plane_strain, s.open_area_m2, NULL) AS open_area_m2_per_m,
       s.max_slip_m,
       iif(m.plane_strain, NULL, s.potency_m3) AS potency_m3,
       iif(m.plane_strain, s.potency_m3, NULL) AS potency_m3_per_m,
       m.pressure_margin_pa, m.weakening_resolved
FROM stage_metrics s
JOIN names n ON n.id = s.stage_id AND n.name = ''
JOIN cases c ON c.id = s.case_id
JOIN case_metrics m ON m.case_id = s.case_id
JOIN campaign_cases cc ON cc.case_id = s.case_id
JOIN campaigns k ON k.id = cc.campaign_id
LEFT JOIN names f ON f.id = s.activated_fault_id
LEFT JOIN names fo ON fo.id = s.opened_fault_id
LEFT JOIN leading_onsets a ON a.case_id = s.case_id AND a.stage_id = s.stage_id AND a.opening = 0
  AND a.fault_id = s.activated_fault_id
LEFT JOIN leading_onsets o ON o.case_id = s.case_id AND o.stage_id = s.stage_id AND o.opening = 1
  AND o.fault_id = s.opened_fault_id
ORDER BY k.id, s.rank_class, s.activated_area_m2 DESC, s.open_area_m2 DESC, s.moment_nm DESC,
         coalesce(s.pressure_margin_pa, 9e99), s.chi_bar DESC, cc.position;

CREATE VIEW stage_ranking AS
SELECT k.name AS campaign, cc.position AS "case", n.name AS stage, m.outcome, m.plane_strain,
       s.max_slip_m > 0 AS slips, s.activated, s.open_area_m2 > 0 AS opens, s.n_events > 0 AS jumps,
       f.name AS activated_fault, s.activation_step, a.depth_m AS activation_depth_m,
       a.change_pa AS activation_pressure_change_pa,
       a.absolute_pa AS activation_pressure_absolute_pa,
       fo.name AS opened_fault, s.opening_step,
       iif(m.plane_strain, NULL, s.activated_area_m2) AS activated_area_m2,
       iif(m.plane_strain, s.activated_area_m2, NULL) AS activated_area_m2_per_m,
       iif(m.plane_strain, NULL, s.moment_nm) AS moment_nm,
       iif(m.plane_strain, s.moment_nm, NULL) AS moment_nm_per_m,
       s.magnitude_if_released_at_once_mw, s.n_events,
       iif(m.plane_strain, NULL, s.event_moment_nm) AS event_moment_nm,
       iif(m.plane_strain, s.event_moment_nm, NULL) AS event_moment_nm_per_m,
       s.event_magnitude_mw, s.chi_bar, s.chi_max,
       iif(m.plane_strain, NULL, s.area_chi_080_m2) AS area_chi_080_m2,
       iif(m.plane_strain, s.area_chi_080_m2, NULL) AS area_chi_080_m2_per_m,
       s.thickness_chi_080_m,
       iif(m.plane_strain, NULL, s.slipping_area_m2) AS slipping_area_m2,
       iif(m.plane_strain, s.slipping_area_m2, NULL) AS slipping_area_m2_per_m,
       iif(m.plane_strain, NULL, s.open_area_m2) AS open_area_m2,
       iif(m.plane_strain, s.open_area_m2, NULL) AS open_area_m2_per_m,
       s.max_slip_m,
       iif(m.plane_strain, NULL, s.potency_m3) AS potency_m3,
       iif(m.plane_strain, s.potency_m3, NULL) AS potency_m3_per_m,
       s.first_step, s.last_step
FROM stage_metrics s
JOIN names n ON n.id = s.stage_id
JOIN case_metrics m ON m.case_id = s.case_id
JOIN campaign_cases cc ON cc.case_id = s.case_id
JOIN campaigns k ON k.id = cc.campaign_id
LEFT JOIN names f ON f.id = s.activated_fault_id
LEFT JOIN names fo ON fo.id = s.opened_fault_id
LEFT JOIN leading_onsets a ON a.case_id = s.case_id AND a.stage_id = s.stage_id AND a.opening = 0
  AND a.fault_id = s.activated_fault_id;

-- A row per case, stage ('' = the whole history) and fault.
CREATE VIEW fault_ranking AS
SELECT k.name AS campaign, cc.position AS "case", n.name AS stage, f.name AS fault, m.outcome,
       m.plane_strain, q.max_slip_m > 0 AS slips, q.activated, q.open_area_m2 > 0 AS opens,
       q.n_events > 0 AS jumps, a.step AS activation_step, a.depth_m AS activation_depth_m,
       am.name AS activation_region_minus,
       a.change_minus_pa AS activation_change_minus_pa,
       a.absolute_minus_pa AS activation_absolute_minus_pa,
       ap.name AS activation_region_plus, a.change_plus_pa AS activation_change_plus_pa,
       a.absolute_plus_pa AS activation_absolute_plus_pa,
       a.change_in_fault_pa AS activation_change_in_fault_pa,
       o.step AS opening_step, o.depth_m AS opening_depth_m,
       o.change_minus_pa AS opening_change_minus_pa,
       o.absolute_minus_pa AS opening_absolute_minus_pa,
       o.change_plus_pa AS opening_change_plus_pa, o.absolute_plus_pa AS opening_absolute_plus_pa,
       iif(m.plane_strain, NULL, q.activated_area_m2) AS activated_area_m2,
       iif(m.plane_strain, q.activated_area_m2, NULL) AS activated_area_m2_per_m,
       iif(m.plane_strain, NULL, q.moment_nm) AS moment_nm,
       iif(m.plane_strain, q.moment_nm, NULL) AS moment_nm_per_m, q.n_events,
       iif(m.plane_strain, NULL, q.event_moment_nm) AS event_moment_nm,
       iif(m.plane_strain, q.event_moment_nm, NULL) AS event_moment_nm_per_m,
       q.event_magnitude_mw, q.chi_bar, q.chi_max,
       iif(m.plane_strain, NULL, q.area_chi_080_m2) AS area_chi_080_m2,
       iif(m.plane_strain, q.area_chi_080_m2, NULL) AS area_chi_080_m2_per_m,
       q.thickness_chi_080_m,
       iif(m.plane_strain, NULL, q.slipping_area_m2) AS slipping_area_m2,
       iif(m.plane_strain, q.slipping_area_m2, NULL) AS slipping_area_m2_per_m,
       iif(m.plane_strain, NULL, q.open_area_m2) AS open_area_m2,
       iif(m.plane_strain, q.open_area_m2, NULL) AS open_area_m2_per_m,
       q.max_slip_m,
       iif(m.plane_strain, NULL, q.potency_m3) AS potency_m3,
       iif(m.plane_strain, q.potency_m3, NULL) AS potency_m3_per_m
FROM fault_metrics q
JOIN names n ON n.id = q.stage_id
JOIN names f ON f.id = q.fault_id
JOIN case_metrics m ON m.case_id = q.case_id
JOIN campaign_cases cc ON cc.case_id = q.case_id
JOIN campaigns k ON k.id = cc.campaign_id
LEFT JOIN fault_onsets a ON a.case_id = q.case_id AND a.stage_id = q.stage_id AND a.opening = 0
  AND a.fault_id = q.fault_id
LEFT JOIN names am ON am.id = a.region_minus_id
LEFT JOIN names ap ON ap.id = a.region_plus_id
LEFT JOIN fault_onsets o ON o.case_id = q.case_id AND o.stage_id = q.stage_id AND o.opening = 1
  AND o.fault_id = q.fault_id;

CREATE VIEW case_events AS
SELECT k.name AS campaign, cc.position AS "case", cc.parameter_labels, m.outcome, m.plane_strain,
       e.number AS event, e.step, g.name AS stage, e.time_s, f.name AS fault, e.depth_m,
       rm.name AS region_minus, e.change_minus_pa, e.absolute_minus_pa,
       rp.name AS region_plus, e.change_plus_pa, e.absolute_plus_pa, e.change_in_fault_pa, e.nucleation_length_m,
       iif(m.plane_strain, NULL, e.slipped_area_m2) AS slipped_area_m2,
       iif(m.plane_strain, e.slipped_area_m2, NULL) AS slipped_area_m2_per_m,
       e.max_slip_m, e.mean_slip_m, e.stress_drop_pa,
       iif(m.plane_strain, NULL, e.potency_m3) AS potency_m3,
       iif(m.plane_strain, e.potency_m3, NULL) AS potency_m3_per_m,
       iif(m.plane_strain, NULL, e.moment_nm) AS moment_nm,
       iif(m.plane_strain, e.moment_nm, NULL) AS moment_nm_per_m,
       e.magnitude_mw, e.duration_s, e.resolved,
       iif(m.plane_strain, NULL, e.energy_released_j) AS energy_released_j,
       iif(m.plane_strain, e.energy_released_j, NULL) AS energy_released_j_per_m,
       iif(m.plane_strain, NULL, e.energy_dissipated_j) AS energy_dissipated_j,
       iif(m.plane_strain, e.energy_dissipated_j, NULL) AS energy_dissipated_j_per_m,
       e.evidence_holds
FROM slip_events e
JOIN names g ON g.id = e.stage_id
LEFT JOIN names f ON f.id = e.fault_id
LEFT JOIN names rm ON rm.id = e.region_minus_id
LEFT JOIN names rp ON rp.id = e.region_plus_id
JOIN case_metrics m ON m.case_id = e.case_id
JOIN campaign_cases cc ON cc.case_id = e.case_id
JOIN campaigns k ON k.id = cc.campaign_id;

-- unexpected: this very episode is the first unexpected reactivation of its case.
CREATE VIEW case_episodes AS
SELECT k.name AS campaign, cc.position AS "case", cc.parameter_labels, m.outcome, m.plane_strain,
       e.number AS episode, e.number IS m.unexpected_episode AS unexpected,
       iif(e.number = m.unexpected_episode, m.unexpected_after, NULL) AS after_episode,
       g.name AS stage, f.name AS fault, e.first_step, e.last_step, e.depth_m,
       rm.name AS region_minus, e.change_minus_pa, e.absolute_minus_pa,
       rp.name AS region_plus, e.change_plus_pa, e.absolute_plus_pa, e.change_in_fault_pa, e.after_recovery,
       iif(m.plane_strain, NULL, e.activated_area_m2) AS activated_area_m2,
       iif(m.plane_strain, e.activated_area_m2, NULL) AS activated_area_m2_per_m,
       e.max_slip_m,
       iif(m.plane_strain, NULL, e.moment_nm) AS moment_nm,
       iif(m.plane_strain, e.moment_nm, NULL) AS moment_nm_per_m,
       e.magnitude_if_released_at_once_mw
FROM episodes e
JOIN names g ON g.id = e.stage_id
JOIN names f ON f.id = e.fault_id
LEFT JOIN names rm ON rm.id = e.region_minus_id
LEFT JOIN names rp ON rp.id = e.region_plus_id
JOIN case_metrics m ON m.case_id = e.case_id
JOIN campaign_cases cc ON cc.case_id = e.case_id
JOIN campaigns k ON k.id = cc.campaign_id;

CREATE VIEW chi_history_wide AS
SELECT k.name AS campaign, cc.position AS "case", m.plane_strain, h.step, g.name AS stage, l.time_s,
       l.pressure_change_pa, f.name AS fault, h.chi_bar, h.chi_max, h.chi_static_max,
       iif(m.plane_strain, NULL, h.area_chi_080_m2) AS area_chi_080_m2,
       iif(m.plane_strain, h.area_chi_080_m2, NULL) AS area_chi_080_m2_per_m,
       h.thickness_chi_080_max_m, h.thickness_chi_080_mean_m,
       iif(m.plane_strain, NULL, h.slipping_area_m2) AS slipping_area_m2,
       iif(m.plane_strain, h.slipping_area_m2, NULL) AS slipping_area_m2_per_m,
       iif(m.plane_strain, NULL, h.open_area_m2) AS open_area_m2,
       iif(m.plane_strain, h.open_area_m2, NULL) AS open_area_m2_per_m,
       iif(m.plane_strain, NULL, h.activated_area_m2) AS activated_area_m2,
       iif(m.plane_strain, h.activated_area_m2, NULL) AS activated_area_m2_per_m,
       h.activated_length_m, h.activated, h.activated_at_edge, h.max_slip_m, h.mean_slip_m,
       iif(m.plane_strain, NULL, h.potency_m3) AS potency_m3,
       iif(m.plane_strain, h.potency_m3, NULL) AS potency_m3_per_m,
       iif(m.plane_strain, NULL, h.moment_nm) AS moment_nm,
       iif(m.plane_strain, h.moment_nm, NULL) AS moment_nm_per_m,
       iif(m.plane_strain, NULL, h.moment_step_nm) AS moment_step_nm,
       iif(m.plane_strain, h.moment_step_nm, NULL) AS moment_step_nm_per_m,
       h.creep_normal_min_pa, h.creep_normal_max_pa, h.creep_shear_max_pa, l.time_steps,
       l.time_error_pa, l.time_resolved
FROM chi_history h
JOIN load_steps l ON l.case_id = h.case_id AND l.step = h.step
JOIN case_metrics m ON m.case_id = h.case_id
JOIN names g ON g.id = l.stage_id
JOIN names f ON f.id = h.fault_id
JOIN campaign_cases cc ON cc.case_id = h.case_id
JOIN campaigns k ON k.id = cc.campaign_id;
