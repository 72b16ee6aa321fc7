-- Migration 2: fault fields of cases (keep_fields of a spec). The schema before it is store.sql.
-- The files are STORE/fields/CAMPAIGN/CASE/faults.h5 and faults.xmf, CASE = campaign_cases.position.

ALTER TABLE campaigns ADD COLUMN keep_fields TEXT NOT NULL DEFAULT 'none'
  CHECK (keep_fields IN ('none', 'stages', 'all'));

-- none: not asked for; wanted: still to be written; kept: in their files; failed: the case has a
-- result, but the run that was to add its fields failed.
ALTER TABLE campaign_cases ADD COLUMN fields TEXT NOT NULL DEFAULT 'none'
  CHECK (fields IN ('none', 'wanted', 'kept', 'failed'));

-- 1: a run of a case that had its result already. It decides nothing but campaign_cases.fields.
ALTER TABLE runs ADD COLUMN fields_only INTEGER NOT NULL DEFAULT 0;

-- How a case stands in a campaign: cases.state, but a case whose fields are missing there is not
-- done there. Most rows are `none` or `kept`, which is asked first: counting reads every row.
CREATE VIEW campaign_case_states AS
SELECT cc.campaign_id, cc.position, cc.case_id, c.family_id, c.run_id, c.outcome, cc.fields,
       CASE WHEN c.state <> 'done' OR cc.fields = 'none' OR cc.fields = 'kept' THEN c.state
            WHEN cc.fields = 'wanted' THEN 'waiting'
            ELSE 'failed' END AS state,
       CASE WHEN cc.fields = 'none' OR cc.fields = 'kept' THEN 0
            ELSE c.state = 'done' END AS lacks_only_fields
FROM campaign_cases cc
JOIN cases c ON c.id = cc.case_id;

DROP VIEW campaign_progress;
CREATE VIEW campaign_progress AS
SELECT k.name AS campaign, k.state, count(*) AS cases, sum(s.state = 'done') AS done,
       sum(s.state = 'failed') AS failed, sum(s.state = 'waiting') AS waiting
FROM campaigns k
JOIN campaign_case_states s ON s.campaign_id = k.id
GROUP BY k.id;

DROP VIEW failures;
CREATE VIEW failures AS
SELECT k.name AS campaign, s.position AS "case", r.attempt, r.status, r.outcome, r.reason,
       r.signal, r.exit_code, r.log_tail, s.state, r.fields_only
FROM runs r
JOIN campaign_case_states s ON s.case_id = r.case_id
JOIN campaigns k ON k.id = s.campaign_id
WHERE (r.status <> 'completed' OR r.outcome <> 'converged')
  AND (r.fields_only = 0 OR r.campaign_id = s.campaign_id);
