-- What the campaign rotliegend-events shows. Its two groups hold the same cases in the same order.
.mode markdown
CREATE TEMP VIEW the_case AS
SELECT cc.position, cc.case_id, la.parameter_labels AS labels, m.*,
       cc.position > (SELECT max(position) / 2 FROM campaign_cases cc2 WHERE cc2.campaign_id = k.id) AS half
FROM campaigns k JOIN campaign_cases cc ON cc.campaign_id = k.id JOIN case_labels la USING (campaign_id, position) JOIN case_metrics m USING (case_id)
WHERE k.name = 'rotliegend-events';

.print '## Every step'
.print
SELECT CASE half WHEN 0 THEN 'as given' ELSE 'half' END AS "load steps", s.outcome, count(*) AS steps
FROM the_case c JOIN load_steps s USING (case_id) GROUP BY half, s.outcome;

.print
.print '## Every case'
.print
SELECT CASE half WHEN 0 THEN 'as given' ELSE 'half' END AS "load steps", outcome, count(*) AS cases
FROM the_case GROUP BY half, outcome;

.print
.print '## Cases with events, by d_c'
.print
SELECT labels ->> '$[4]' AS d_c, count(*) AS cases, sum(n > 0) AS "with events",
       sum(outcome = 'event') AS resolved, sum(n) AS events, round(max(largest), 1) AS "largest M0, GN m per m"
FROM (SELECT c.*, (SELECT count(*) FROM slip_events e WHERE e.case_id = c.case_id) AS n,
             (SELECT max(moment_nm) / 1e9 FROM slip_events e WHERE e.case_id = c.case_id) AS largest
      FROM the_case c WHERE NOT half)
GROUP BY labels ->> '$[4]' ORDER BY min(position);

.print
.print '## Evidence of all events'
.print
SELECT count(*) AS events, sum(evidence_holds) AS "evidence holds",
       max(load_factor_after - load_factor_before) AS "widest bracket",
       round(max(residual_before), 3) AS "worst residual before", round(max(residual_after), 3) AS "and after",
       min(negative_pivots + n_lost_cohesion) AS "fewest negative pivots",
       min(energy_released_j >= energy_dissipated_j) AS "released ≥ dissipated"
FROM slip_events JOIN the_case USING (case_id);

.print
.print '## Onset at half the load step'
.print
CREATE TEMP VIEW onsets AS
SELECT *, min(coalesce(change_minus_pa, change_plus_pa), coalesce(change_plus_pa, change_minus_pa)) AS change_pa FROM slip_events;
CREATE TEMP VIEW moved AS
SELECT a.position, a.labels, e.number,
       (SELECT min(abs(f.change_pa - e.change_pa)) FROM onsets f
        WHERE f.case_id = b.case_id AND abs(f.time_s - e.time_s) <= 0.25 * 31557600) / abs(e.change_pa) AS move
FROM the_case a JOIN the_case b
  ON b.position = a.position + (SELECT max(position) / 2 FROM the_case) JOIN onsets e ON e.case_id = a.case_id
WHERE NOT a.half;
SELECT count(*) AS events, sum(move IS NULL) AS "none within a quarter of a year", sum(move > 0.01) AS "moved by > 1 %",
       sum(move > 0.0001) AS "moved by > 0.01 %", printf('%.2g %%', 100 * max(move)) AS "largest move"
FROM moved;

.print
.print '## Work'
.print
SELECT CASE half WHEN 0 THEN 'as given' ELSE 'half' END AS "load steps", sum(n_steps) AS steps, sum(sub_steps) AS "sub-steps",
       sum(active_set_passes) AS passes, sum(newton_iterations) AS "Newton iterations",
       sum(wasted_newton_iterations) AS wasted, max(newton_iterations + wasted_newton_iterations) AS "most in a case",
       round(sum(r.wall_s), 1) AS "seconds, one core", round(max(r.wall_s), 2) AS "longest case"
FROM the_case c JOIN runs r ON r.id = c.run_id GROUP BY half;
