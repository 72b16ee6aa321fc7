-- The views whose columns are the measures of stages and faults (simulator/output/measures.h).
-- MEASURES(s) stands for these columns of the row s: of what is per metre of strike in plane strain
-- two, of which one is NULL. Every migration from 11 on makes the views anew.

DROP VIEW IF EXISTS ranking;
CREATE VIEW ranking AS
SELECT k.name AS campaign, cc.position AS "case", c.identity, cc.parameter_labels, m.outcome,
       s.rank_class, m.plane_strain, MEASURES(s), s.n_events > 0 AS jumps,
       f.name AS activated_fault, s.activation_step, a.depth_m AS activation_depth_m,
       a.change_pa AS activation_pressure_change_pa,
       a.absolute_pa AS activation_pressure_absolute_pa, fo.name AS opened_fault, s.opening_step,
       o.depth_m AS opening_depth_m, o.change_pa AS opening_pressure_change_pa,
       o.absolute_pa AS opening_pressure_absolute_pa, s.magnitude_if_released_at_once_mw,
       m.n_episodes, m.unexpected_episode IS NOT NULL AS unexpected, m.unexpected_episode,
       m.unexpected_after, m.pressure_margin_pa, m.weakening_resolved
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

DROP VIEW IF EXISTS stage_ranking;
CREATE VIEW stage_ranking AS
SELECT k.name AS campaign, cc.position AS "case", n.name AS stage, m.outcome, m.plane_strain,
       MEASURES(s), s.n_events > 0 AS jumps, f.name AS activated_fault, s.activation_step,
       a.depth_m AS activation_depth_m, a.change_pa AS activation_pressure_change_pa,
       a.absolute_pa AS activation_pressure_absolute_pa, fo.name AS opened_fault, s.opening_step,
       s.magnitude_if_released_at_once_mw, s.first_step, s.last_step
FROM stage_metrics s
JOIN names n ON n.id = s.stage_id
JOIN case_metrics m ON m.case_id = s.case_id
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
       o.change_plus_pa AS opening_change_plus_pa, o.absolute_plus_pa AS opening_absolute_plus_pa
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
