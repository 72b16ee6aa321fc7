-- The tables of table.md, of the JSON that make has left in :work.
CREATE TABLE r AS SELECT
    CAST(substr(value ->> '$.h', 3) AS INTEGER) AS n, value ->> '$.case' AS body, value ->> '$.stage' AS stage, value ->> '$.displacement_dofs' AS u, value ->> '$.multiplier_dofs' AS l,
    value ->> '$.leading' AS leading, value ->> '$.schur' AS schur, value ->> '$.form' AS form, value ->> '$.fsai.steps' AS steps,
    ifnull(value ->> '$.random.1e-6', '–') AS r6, ifnull(value ->> '$.random.1e-8', '–') AS r8,
    ifnull(value ->> '$.physical.1e-6', '–') AS p6, ifnull(value ->> '$.physical.1e-8', '–') AS p8,
    value ->> '$.setup_s' AS setup, value ->> '$.solve_s' AS solve, value ->> '$.preconditioner_bytes' / 1e6 AS mb
  FROM (SELECT 1 AS part UNION SELECT 2 UNION SELECT 3 UNION SELECT 4 UNION SELECT 5 UNION SELECT 6
      UNION SELECT 7 UNION SELECT 8 UNION SELECT 9 UNION SELECT 10 UNION SELECT 11),
    json_each(readfile(:work || '/' || part || '.json'), '$.rows');
CREATE TABLE every AS SELECT * FROM r;
DELETE FROM r WHERE body <> 'box' OR stage <> 'stick';
CREATE TABLE seed (n, f5, f20, bds, lsc);
INSERT INTO seed VALUES (2, 22, 20, 27, 22), (4, 29, 25, 34, 27), (8, 35, 20, 40, 32), (16, 42, 36, 48, 39), (32, 49, 43, 56, 46);
SELECT '# Preconditioners of the coupled path';
SELECT '';
SELECT 'Made by `results/solver-study/make`. Beside the seed''s: iterations to 1e-6 for a random/physical right-hand side.';
SELECT '';
SELECT '| h | u dofs | λ dofs | FSAI(5) ours | seed | FSAI(20) ours | seed | BDS ours | seed | LSC ours | seed |';
SELECT '|---|---|---|---|---|---|---|---|---|---|---|';
SELECT printf('| 1/%d | %d | %d | %s/%s | %d | %s/%s | %d | %s/%s | %d | %s/%s | %d |', a.n, a.u, a.l, a.r6, a.p6, f5, b.r6, b.p6, f20,
    c.r6, c.p6, seed.bds, d.r6, d.p6, seed.lsc)
  FROM seed JOIN r a ON a.n = seed.n AND a.form = 'full' AND a.schur = 'fsai+dir' AND a.steps = 5
    JOIN r b ON b.n = seed.n AND b.form = 'full' AND b.schur = 'fsai+dir' AND b.steps = 20
    JOIN r c ON c.n = seed.n AND c.form = 'full' AND c.schur = 'bds'
    JOIN r d ON d.n = seed.n AND d.form = 'full' AND d.schur = 'lsc' ORDER BY a.n;
SELECT '';
SELECT 'RAC with one V-cycle of AMG, the same iterations; set-up and solve of the first AMG, to 1e-8 of one right-hand side.';
SELECT '';
SELECT '| h | u dofs | AMG | AMG, components apart | exact | seed''s best, FSAI(20) | set-up, solve, s | MB |';
SELECT '|---|---|---|---|---|---|---|---|';
SELECT printf('| 1/%d | %d | %s/%s | %s | %s | %d | %.2f, %.2f | %.0f |', a.n, a.u, a.r6, a.p6, ifnull(c.r6 || '/' || c.p6, '–'),
    ifnull(e.r6 || '/' || e.p6, '–'), f20, a.setup, a.solve, a.mb)
  FROM seed JOIN r a ON a.n = seed.n AND a.leading = 'amg' AND a.schur = 'rac' AND a.form = 'upper'
    LEFT JOIN r c ON c.n = a.n AND c.leading = 'amg-u' AND c.schur = 'rac' AND c.form = 'upper'
    LEFT JOIN r e ON e.n = a.n AND e.leading = 'exact' AND e.schur = 'rac' AND e.form = 'upper' ORDER BY a.n;
SELECT '';
SELECT '| h | K + E | Schur | form | random 1e-6 | 1e-8 | physical 1e-6 | 1e-8 | set-up, s | solve, s | MB |';
SELECT '|---|---|---|---|---|---|---|---|---|---|---|';
SELECT printf('| 1/%d | %s | %s | %s | %s | %s | %s | %s | %.2f | %.2f | %.1f |', n, leading,
    schur || CASE WHEN schur LIKE 'fsai%' THEN ' (' || steps || ')' ELSE '' END, form, r6, r8, p6, p8, setup, solve, mb) FROM r
  ORDER BY n, form DESC, CASE leading WHEN 'exact' THEN 0 WHEN 'amg' THEN 1 WHEN 'amg-u' THEN 2 WHEN 'ic' THEN 3 WHEN 'ilu' THEN 4 ELSE 5 END, schur, steps;
SELECT '';
SELECT 'Stand-ins for the field cases, all in stick; the seed''s to a tolerance that it does not give, on meshes that are not public, with FSAI, IC and exact alone:';
SELECT '';
SELECT '| case | u dofs | λ dofs | K + E | Schur | random 1e-6 | 1e-8 | physical 1e-6 | 1e-8 | seed | set-up, s | solve, s | MB |';
SELECT '|---|---|---|---|---|---|---|---|---|---|---|---|---|';
CREATE TABLE seed_field (body, leading, schur, n);
INSERT INTO seed_field VALUES
  ('15-cuts', 'fsai', 'fsai+dir', 409), ('15-cuts', 'fsai', 'bds', 482), ('15-cuts', 'fsai', 'lsc', 866),
  ('15-cuts', 'ic', 'fsai+dir', 229), ('15-cuts', 'ic', 'bds', 574), ('15-cuts', 'ic', 'lsc', 407),
  ('field-a', 'fsai', 'fsai+dir', 123), ('field-a', 'fsai', 'bds', 255), ('field-a', 'fsai', 'lsc', 175),
  ('field-a', 'ic', 'fsai+dir', 98), ('field-a', 'ic', 'bds', 240), ('field-a', 'ic', 'lsc', 59),
  ('field-b', 'fsai', 'fsai+dir', 72), ('field-b', 'fsai', 'bds', 371), ('field-b', 'fsai', 'lsc', 77),
  ('field-b', 'ic', 'fsai+dir', 34), ('field-b', 'ic', 'bds', 189), ('field-b', 'ic', 'lsc', 24),
  ('field-b', 'exact', 'fsai+dir', 21), ('field-b', 'exact', 'bds', 129), ('field-b', 'exact', 'lsc', 12),
  ('field-c', 'fsai', 'fsai+dir', 496), ('field-c', 'fsai', 'lsc', 768), ('field-c', 'ic', 'fsai+dir', 194), ('field-c', 'ic', 'lsc', 125);
SELECT printf('| %s | %d | %d | %s | %s | %s | %s | %s | %s | %s | %.2f | %.2f | %.0f |', body, u, l, leading, schur, r6, r8, p6, p8,
    ifnull(seed_field.n, ''), setup, solve, mb) FROM every LEFT JOIN seed_field USING (body, leading, schur)
  WHERE body <> 'box' AND stage = 'stick'
  ORDER BY body, CASE leading WHEN 'exact' THEN 0 WHEN 'amg' THEN 1 WHEN 'amg-u' THEN 2 WHEN 'ic' THEN 3 ELSE 5 END, schur;
SELECT '';
SELECT 'Through a history: iterations to 1e-6, random/physical, with all nodes in stick, with the middle of the faults in slip, and with the middle of that open:';
SELECT '';
SELECT '| case | K + E | Schur | stick | slip | open | largest |';
SELECT '|---|---|---|---|---|---|---|';
SELECT printf('| %s | %s | %s | %s/%s | %s/%s | %s/%s | %s |', CASE a.body WHEN 'box' THEN '1/' || a.n ELSE a.body END, a.leading, a.schur, a.r6, a.p6,
    b.r6, b.p6, c.r6, c.p6, max(a.r6, a.p6, b.r6, b.p6, c.r6, c.p6))
  FROM every a JOIN every b ON b.body = a.body AND b.n IS a.n AND b.leading = a.leading AND b.schur = a.schur AND b.form = a.form
    JOIN every c ON c.body = a.body AND c.n IS a.n AND c.leading = a.leading AND c.schur = a.schur AND c.form = a.form
  WHERE a.stage = 'stick' AND b.stage = 'slip' AND c.stage = 'open' ORDER BY a.body, a.n, a.leading, a.schur;
-- A history: how far from the condensed path, in how many iterations.
CREATE TABLE history AS SELECT way, readfile(:work || '/' || way || '/result.json') AS result
  FROM (SELECT 'condensed' AS way UNION SELECT 'amg-u' UNION SELECT 'amg');
CREATE TABLE fault AS SELECT way, s.key AS step, f.key AS fault, f.value ->> '$.chi_bar' AS chi_bar, f.value ->> '$.max_slip_m' AS slip
  FROM history, json_each(result, '$.steps') s, json_each(s.value, '$.faults') f;
SELECT '';
SELECT 'A history of the starter field, `screening`, friction 16°, RAC:';
SELECT '';
SELECT '| K + E | Newton | GMRES, all | most in one | seconds of solves | χ̄ off the condensed path | slip off, m |';
SELECT '|---|---|---|---|---|---|---|';
SELECT printf('| %s | %d | %d | %d | %.1f | %.0e | %.0e |', way, result ->> '$.counts.newton_iterations',
    (SELECT sum(k.value) FROM json_each(result, '$.steps') s, json_each(s.value, '$.coupled.krylov_iterations') k),
    (SELECT max(k.value) FROM json_each(result, '$.steps') s, json_each(s.value, '$.coupled.krylov_iterations') k),
    (SELECT sum(s.value ->> '$.coupled.solve_s') FROM json_each(result, '$.steps') s),
    (SELECT max(abs(a.chi_bar - b.chi_bar)) FROM fault a JOIN fault b USING (step, fault) WHERE a.way = h.way AND b.way = 'condensed'),
    (SELECT max(abs(a.slip - b.slip)) FROM fault a JOIN fault b USING (step, fault) WHERE a.way = h.way AND b.way = 'condensed'))
  FROM history h WHERE way <> 'condensed' ORDER BY way DESC;
