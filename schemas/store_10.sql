-- Migration 10: flags of activation that depend on the mesh (docs/model.md, section 7). The schema
-- before it is store.sql, store_2.sql to store_9.sql.
--
-- rank_class of stage_metrics and fault_metrics is 1 also where activation_resolved is 0: complete,
-- but the flag or the size of events is the mesh's.

-- 1: slides for certain, or certainly not. NULL: stored before this migration, not known.
ALTER TABLE stage_metrics ADD COLUMN activation_resolved INTEGER;
ALTER TABLE fault_metrics ADD COLUMN activation_resolved INTEGER;
ALTER TABLE chi_history ADD COLUMN activation_resolved INTEGER;

DROP VIEW ranking;
CREATE VIEW ranking AS
SELECT k.name AS campaign, cc.position AS "case", c.identity, cc.parameter_labels,
       m.outcome, s.rank_class, m.plane_strain, s.max_slip_m > 0 AS slips, s.activated,
       s.activation_resolved,
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

DROP VIEW stage_ranking;
CREATE VIEW stage_ranking AS
SELECT k.name AS campaign, cc.position AS "case", n.name AS stage, m.outcome, m.plane_strain,
       s.max_slip_m > 0 AS slips, s.activated,
       s.activation_resolved, s.open_area_m2 > 0 AS opens, s.n_events > 0 AS jumps,
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

DROP VIEW fault_ranking;
CREATE VIEW fault_ranking AS
SELECT k.name AS campaign, cc.position AS "case", n.name AS stage, f.name AS fault, m.outcome,
       m.plane_strain, q.max_slip_m > 0 AS slips, q.activated,
       q.activation_resolved, q.open_area_m2 > 0 AS opens,
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

DROP VIEW chi_history_wide;
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
       h.activated_length_m, h.activated,
       h.activation_resolved, h.activated_at_edge, h.max_slip_m, h.mean_slip_m,
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
