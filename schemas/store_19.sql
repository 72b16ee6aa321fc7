-- Migration 19: fault fields of the cases that are shown first (keep_fields: shown). The schema before
-- it is store.sql, store_2.sql to store_18.sql. Campaigns of before keep what they kept.

-- Those that name the column, directly or through another view.
DROP VIEW failures;  -- made anew by views.sql
DROP VIEW campaign_progress;
DROP VIEW campaign_case_states;

-- A column's CHECK cannot be changed: the values move to a column with the new one.
ALTER TABLE campaigns ADD COLUMN fields_kept TEXT NOT NULL DEFAULT 'none'
  CHECK (fields_kept IN ('none', 'shown', 'stages', 'all'));
UPDATE campaigns SET fields_kept = keep_fields;
ALTER TABLE campaigns DROP COLUMN keep_fields;
ALTER TABLE campaigns RENAME COLUMN fields_kept TO keep_fields;

-- As in store_3.sql, but where only the fields of the cases shown first are kept a case is done
-- when it has its result, whether its fields are wanted yet or could not be added.
CREATE VIEW campaign_case_states AS
SELECT cc.campaign_id, cc.position, cc.case_id, c.family_id, c.run_id, c.outcome, cc.fields,
       CASE WHEN c.state <> 'done' OR cc.fields = 'none' OR cc.fields = 'kept' THEN c.state
            WHEN (SELECT k.keep_fields FROM campaigns k WHERE k.id = cc.campaign_id) = 'shown'
              THEN c.state
            WHEN cc.fields = 'wanted' THEN 'waiting'
            ELSE 'failed' END AS state,
       CASE WHEN cc.fields = 'none' OR cc.fields = 'kept' THEN 0
            ELSE c.state = 'done' END AS lacks_only_fields,
       coalesce(c.outcome IN ('converged', 'event', 'unresolved_event'), 0) AS complete
FROM campaign_cases cc
JOIN cases c ON c.id = cc.case_id;

-- As in store_3.sql.
CREATE VIEW campaign_progress AS
SELECT k.name AS campaign, k.state, count(*) AS cases, sum(s.state = 'done') AS done,
       sum(s.state = 'done' AND s.outcome = 'converged') AS converged,
       sum(s.state = 'done' AND s.outcome = 'event') AS with_events,
       sum(s.state = 'done' AND s.outcome = 'unresolved_event') AS with_unresolved_events,
       sum(s.state = 'failed') AS failed, sum(s.state = 'waiting') AS waiting
FROM campaigns k
JOIN campaign_case_states s ON s.campaign_id = k.id
GROUP BY k.id;
