-- Migration 4: salt that creeps (docs/model.md, section 9). The schema before it is store.sql,
-- store_2.sql, store_3.sql.

-- 1, or, where salt creeps, 1 + the number of step lengths: each worker that runs such a family
-- builds these operators for itself and holds all of them; none is kept in a file.
ALTER TABLE families ADD COLUMN n_operators INTEGER NOT NULL DEFAULT 1 CHECK (n_operators >= 1);

-- NULL in the columns that follow: nothing creeps, or stored before this migration.
ALTER TABLE load_steps ADD COLUMN time_steps INTEGER;       -- that the load step was divided into
ALTER TABLE load_steps ADD COLUMN time_error_pa REAL;       -- when a time step was halved, at most
ALTER TABLE load_steps ADD COLUMN time_resolved INTEGER;    -- 0: more than creep_tolerance
-- What creep did to a fault's tractions: beyond what pressure and slip alone would give.
ALTER TABLE chi_history ADD COLUMN creep_normal_min_pa REAL;  -- most compressive change
ALTER TABLE chi_history ADD COLUMN creep_normal_max_pa REAL;  -- most tensile change
ALTER TABLE chi_history ADD COLUMN creep_shear_max_pa REAL;   -- largest change of shear traction

DROP VIEW chi_history_wide;
CREATE VIEW chi_history_wide AS
SELECT k.name AS campaign, cc.position AS "case", h.step, g.name AS stage, l.time_s,
       l.pressure_change_pa, f.name AS fault, h.chi_bar, h.chi_max, h.chi_static_max,
       h.area_chi_080_m2, h.thickness_chi_080_max_m, h.thickness_chi_080_mean_m, h.slipping_area_m2,
       h.open_area_m2, h.activated_area_m2, h.activated_length_m, h.activated, h.activated_at_edge,
       h.max_slip_m, h.mean_slip_m, h.potency_m3, h.moment_nm, h.moment_step_nm,
       h.creep_normal_min_pa, h.creep_normal_max_pa, h.creep_shear_max_pa, l.time_steps,
       l.time_error_pa, l.time_resolved
FROM chi_history h
JOIN load_steps l ON l.case_id = h.case_id AND l.step = h.step
JOIN names g ON g.id = l.stage_id
JOIN names f ON f.id = h.fault_id
JOIN campaign_cases cc ON cc.case_id = h.case_id
JOIN campaigns k ON k.id = cc.campaign_id;
