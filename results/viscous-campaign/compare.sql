-- Numbers of each case as stored by the campaigns (1 and 2 workers) against those of the case run alone, compared as text of
-- shortest round-trip digits: equal text is equal bits. :work is the folder of results/viscous-campaign/make.
.mode list
CREATE TEMP TABLE pair AS
WITH RECURSIVE n(k) AS (SELECT 1 UNION ALL SELECT k + 1 FROM n WHERE k < 32), w(i) AS (VALUES (1), (2))
SELECT k, i, json(readfile(:work || '/alone/' || k || '/result.json')) AS alone,
       json(readfile(:work || '/alone/' || k || '/stored-' || i || '.json')) -> '$.result' AS stored
FROM n, w;
-- Left out is what the store does not keep: observations, counts of single steps, names; and wall times.
CREATE TEMP TABLE number AS
SELECT pair.k, pair.i, t.fullkey, t.type, pair.stored -> t.fullkey AS stored, pair.alone -> t.fullkey AS alone
FROM pair, json_tree(pair.stored) AS t
WHERE t.type NOT IN ('object', 'array') AND t.key <> 'wall_s' AND t.fullkey NOT LIKE '%counts%'
  AND t.fullkey NOT LIKE '%observ%' AND t.fullkey NOT LIKE '%title%';
SELECT 'Numbers of the stored results that are those of the case alone, bit for bit: ' || sum(stored IS alone) || ' of ' ||
       count(*) || ' (' || sum(fullkey LIKE '%creep%') || ' of them on creep). Largest difference: ' ||
       coalesce(max(abs(stored - alone)), 0) || '.'
FROM number;
SELECT '' UNION ALL
SELECT '* differs: case ' || k || ', ' || i || ' workers, ' || fullkey || ': ' || coalesce(stored, 'nothing') || ' and ' ||
       coalesce(alone, 'nothing')
FROM (SELECT * FROM number WHERE stored IS NOT alone LIMIT 20);
SELECT 'Activated are ' || sum(alone ->> '$.whole.activated') || ' of the 32 cases, ' ||
       'time steps per case: ' || min(n) || ' to ' || max(n) || '.'
FROM (SELECT pair.alone, (SELECT sum(s.value ->> '$.creep.time_steps') FROM json_each(pair.alone, '$.steps') s) AS n
      FROM pair WHERE i = 1);
