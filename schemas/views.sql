-- The views whose columns are the measures of stages and faults (simulator/result/measures.h),
-- those with the parameters of cases, and failures. MEASURES(s) stands for these columns of the row s: of what is
-- per metre of strike in plane strain two, of which one is NULL. The last migration makes the views
-- anew.
--
-- How exact a result is (docs/model.md, section 12) stands beside its measures: surface_... are NULL
-- of exact operators, field_coverage and field_assumed without a flow result.

-- The values of a case's parameters, a row each.
DROP VIEW IF EXISTS parameters;
CREATE VIEW parameters AS
SELECT k.name AS campaign, p.position AS "case", j.name AS parameter, j.dimension, p.si, p.text
FROM campaigns k
JOIN case_parameters p ON p.campaign_id = k.id
JOIN campaign_parameters j ON j.campaign_id = k.id AND j.parameter = p.parameter;

-- The same in one column: a JSON list in the order of the campaign's parameters. SQLite's JSON
-- functions are not for views of an untrusted file.
DROP VIEW IF EXISTS case_labels;
CREATE VIEW case_labels AS
SELECT cc.campaign_id, cc.position,
       '[' || coalesce((SELECT group_concat(label) FROM
        (SELECT coalesce('"' || replace(replace(p.text, '\', '\\'), '"', '\"') || '"', 'null') AS label
         FROM campaign_parameters j
         LEFT JOIN case_parameters p ON p.campaign_id = cc.campaign_id AND p.position = cc.position
           AND p.parameter = j.parameter
         WHERE j.campaign_id = cc.campaign_id ORDER BY j.parameter)), '') || ']' AS parameter_labels
FROM campaign_cases cc;

DROP VIEW IF EXISTS ranking;
CREATE VIEW ranking AS
SELECT k.name AS campaign, cc.position AS "case", c.identity, la.parameter_labels, m.outcome,
       s.rank_class, m.plane_strain, MEASURES(s), s.n_events > 0 AS jumps,
       f.name AS activated_fault, s.activation_step, a.depth_m AS activation_depth_m,
       a.change_pa AS activation_pressure_change_pa,
       a.absolute_pa AS activation_pressure_absolute_pa, fo.name AS opened_fault, s.opening_step,
       o.depth_m AS opening_depth_m, o.change_pa AS opening_pressure_change_pa,
       o.absolute_pa AS opening_pressure_absolute_pa, s.magnitude_if_released_at_once_mw,
       m.n_episodes, m.unexpected_episode IS NOT NULL AS unexpected, m.unexpected_episode,
       m.unexpected_after, m.pressure_margin_pa, m.weakening_resolved, u.operators AS surface_operators,
       u.error_of_stiffness AS surface_error_of_stiffness,
       u.error_of_traction AS surface_error_of_traction, u.error_of_slip AS surface_error_of_slip,
       u.error_of_stability AS surface_error_of_stability,
       m.field_coverage, m.field_assumed
FROM stage_metrics s
JOIN names n ON n.id = s.stage_id AND n.name = ''
JOIN cases c ON c.id = s.case_id
JOIN case_metrics m ON m.case_id = s.case_id
LEFT JOIN case_surfaces u ON u.case_id = s.case_id
JOIN campaign_cases cc ON cc.case_id = s.case_id
JOIN campaigns k ON k.id = cc.campaign_id
JOIN case_labels la ON la.campaign_id = cc.campaign_id AND la.position = cc.position
LEFT JOIN names f ON f.id = s.activated_fault_id
LEFT JOIN names fo ON fo.id = s.opened_fault_id
LEFT JOIN leading_onsets a ON a.case_id = s.case_id AND a.stage_id = s.stage_id AND a.opening = 0
  AND a.fault_id = s.activated_fault_id
LEFT JOIN leading_onsets o ON o.case_id = s.case_id AND o.stage_id = s.stage_id AND o.opening = 1
  AND o.fault_id = s.opened_fault_id
ORDER BY k.id, s.rank_class, s.activated_area_m2 DESC, s.open_area_m2 DESC, s.moment_nm DESC,
         coalesce(s.pressure_margin_pa, 9e99), s.chi_bar DESC, cc.position;

DROP VIEW IF EXISTS stage_ranking;
CREATE VIEW stage_ranking AS
SELECT k.name AS campaign, cc.position AS "case", n.name AS stage, m.outcome, m.plane_strain,
       MEASURES(s), s.n_events > 0 AS jumps, f.name AS activated_fault, s.activation_step,
       a.depth_m AS activation_depth_m, a.change_pa AS activation_pressure_change_pa,
       a.absolute_pa AS activation_pressure_absolute_pa, fo.name AS opened_fault, s.opening_step,
       s.magnitude_if_released_at_once_mw, s.first_step, s.last_step,
       u.operators AS surface_operators,
       u.error_of_stiffness AS surface_error_of_stiffness,
       u.error_of_traction AS surface_error_of_traction, u.error_of_slip AS surface_error_of_slip,
       u.error_of_stability AS surface_error_of_stability,
       m.field_coverage, m.field_assumed
FROM stage_metrics s
JOIN names n ON n.id = s.stage_id
JOIN case_metrics m ON m.case_id = s.case_id
LEFT JOIN case_surfaces u ON u.case_id = s.case_id
JOIN campaign_cases cc ON cc.case_id = s.case_id
JOIN campaigns k ON k.id = cc.campaign_id
LEFT JOIN names f ON f.id = s.activated_fault_id
LEFT JOIN names fo ON fo.id = s.opened_fault_id
LEFT JOIN leading_onsets a ON a.case_id = s.case_id AND a.stage_id = s.stage_id AND a.opening = 0
  AND a.fault_id = s.activated_fault_id;

DROP VIEW IF EXISTS fault_ranking;
CREATE VIEW fault_ranking AS
SELECT k.name AS campaign, cc.position AS "case", n.name AS stage, f.name AS fault, m.outcome,
       m.plane_strain, MEASURES(q), q.n_events > 0 AS jumps, a.step AS activation_step,
       a.depth_m AS activation_depth_m, am.name AS activation_region_minus,
       a.change_minus_pa AS activation_change_minus_pa,
       a.absolute_minus_pa AS activation_absolute_minus_pa, ap.name AS activation_region_plus,
       a.change_plus_pa AS activation_change_plus_pa,
       a.absolute_plus_pa AS activation_absolute_plus_pa,
       a.change_in_fault_pa AS activation_change_in_fault_pa, o.step AS opening_step,
       o.depth_m AS opening_depth_m, o.change_minus_pa AS opening_change_minus_pa,
       o.absolute_minus_pa AS opening_absolute_minus_pa,
       o.change_plus_pa AS opening_change_plus_pa, o.absolute_plus_pa AS opening_absolute_plus_pa,
       u.operators AS surface_operators,
       u.error_of_stiffness AS surface_error_of_stiffness,
       u.error_of_traction AS surface_error_of_traction, u.error_of_slip AS surface_error_of_slip,
       u.error_of_stability AS surface_error_of_stability,
       m.field_coverage, m.field_assumed
FROM fault_metrics q
JOIN names n ON n.id = q.stage_id
JOIN names f ON f.id = q.fault_id
JOIN case_metrics m ON m.case_id = q.case_id
LEFT JOIN case_surfaces u ON u.case_id = q.case_id
JOIN campaign_cases cc ON cc.case_id = q.case_id
JOIN campaigns k ON k.id = cc.campaign_id
LEFT JOIN fault_onsets a ON a.case_id = q.case_id AND a.stage_id = q.stage_id AND a.opening = 0
  AND a.fault_id = q.fault_id
LEFT JOIN names am ON am.id = a.region_minus_id
LEFT JOIN names ap ON ap.id = a.region_plus_id
LEFT JOIN fault_onsets o ON o.case_id = q.case_id AND o.stage_id = q.stage_id AND o.opening = 1
  AND o.fault_id = q.fault_id;

-- One row per slip event of each case, with the case's parameters.
DROP VIEW IF EXISTS case_events;
CREATE VIEW case_events AS
SELECT k.name AS campaign, cc.position AS "case", la.parameter_labels, m.outcome, m.plane_strain,
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
JOIN campaigns k ON k.id = cc.campaign_id
JOIN case_labels la ON la.campaign_id = cc.campaign_id AND la.position = cc.position;

-- unexpected: this very episode is the first unexpected reactivation of its case.
DROP VIEW IF EXISTS case_episodes;
CREATE VIEW case_episodes AS
SELECT k.name AS campaign, cc.position AS "case", la.parameter_labels, m.outcome, m.plane_strain,
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
JOIN campaigns k ON k.id = cc.campaign_id
JOIN case_labels la ON la.campaign_id = cc.campaign_id AND la.position = cc.position;

-- Cases whose last attempt failed or did not get to the end of the history; of those whose fields alone
-- failed the last attempt at them, which is their campaign's own.
DROP VIEW IF EXISTS failures;
CREATE VIEW failures AS
SELECT k.name AS campaign, s.position AS "case", r.attempt, r.status, r.outcome, r.reason,
       r.signal, r.exit_code, r.log_tail, s.state, r.fields_only
FROM runs r
JOIN campaign_case_states s ON s.case_id = r.case_id
JOIN campaigns k ON k.id = s.campaign_id
WHERE (r.status <> 'completed' OR r.outcome NOT IN ('converged', 'event', 'unresolved_event'))
  AND (r.fields_only = 0 OR r.campaign_id = s.campaign_id)
  AND NOT EXISTS (
    SELECT 1 FROM runs later WHERE later.case_id = r.case_id AND later.attempt > r.attempt
      AND later.fields_only = r.fields_only
      AND (later.fields_only = 0 OR later.campaign_id = s.campaign_id));
