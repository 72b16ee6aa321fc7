-- Migration 13: parameters of cases as a table, and rounds. The schema before it is store.sql,
-- store_2.sql to store_11.sql, and version 12 added a measure. exact_real reads a JSON number (campaign/store/sqlite.cc).

DROP VIEW IF EXISTS ranking;
DROP VIEW case_events;
DROP VIEW case_episodes;

-- campaigns.parameters as rows.
CREATE TABLE campaign_parameters (
  campaign_id INTEGER NOT NULL REFERENCES campaigns (id),
  parameter INTEGER NOT NULL,          -- from 0
  name TEXT NOT NULL,
  dimension TEXT NOT NULL,             -- "text" of words
  PRIMARY KEY (campaign_id, parameter)
) STRICT, WITHOUT ROWID;
INSERT INTO campaign_parameters
  SELECT k.id, j.key, coalesce(j.value ->> 'name', ''), coalesce(j.value ->> 'dimension', '')
  FROM campaigns k, json_each(k.parameters) j;

-- A parameter that a case of a campaign has; those of other groups are missing.
CREATE TABLE case_parameters (
  campaign_id INTEGER NOT NULL,
  position INTEGER NOT NULL,           -- of the case in the campaign
  parameter INTEGER NOT NULL,          -- from 0: as in campaign_parameters
  si REAL,                             -- null = words
  text TEXT NOT NULL,                  -- as given, with its unit
  PRIMARY KEY (campaign_id, position, parameter),
  FOREIGN KEY (campaign_id, position) REFERENCES campaign_cases (campaign_id, position)
) STRICT, WITHOUT ROWID;
INSERT INTO case_parameters
  SELECT cc.campaign_id, cc.position, l.key, exact_real(cc.parameter_values -> l.key), l.value
  FROM campaign_cases cc, json_each(cc.parameter_labels) l WHERE l.type = 'text';
ALTER TABLE campaign_cases DROP COLUMN parameter_values;
ALTER TABLE campaign_cases DROP COLUMN parameter_labels;

-- A campaign is a sequence of rounds. Round 0 is the design of its spec; a later one follows from
-- the spec and from what became of the cases of the rounds before it.
CREATE TABLE rounds (
  campaign_id INTEGER NOT NULL REFERENCES campaigns (id),
  round INTEGER NOT NULL,              -- from 0
  first_position INTEGER NOT NULL,     -- of its cases in the campaign, which are consecutive
  n_cases INTEGER NOT NULL,            -- that no earlier round has
  design TEXT NOT NULL,                -- JSON, as in a spec; "" of round 0
  reason TEXT NOT NULL,                -- for people
  proposed_at REAL NOT NULL,
  PRIMARY KEY (campaign_id, round)
) STRICT, WITHOUT ROWID;
INSERT INTO rounds
  SELECT k.id, 0, 1, (SELECT count(*) FROM campaign_cases cc WHERE cc.campaign_id = k.id), '', '',
         k.submitted_at
  FROM campaigns k;
-- Why no further round was proposed when its cases were decided; "" = it was not asked, or has one.
ALTER TABLE campaigns ADD COLUMN conclusion TEXT NOT NULL DEFAULT '';
