-- Migration 8: checksums of what was stored, and a time limit of operators. The schema before it is
-- store.sql, store_2.sql to store_7.sql.

ALTER TABLE campaigns ADD COLUMN operator_time_limit_s REAL;  -- null = by the prediction

-- Of all that a case's result consists of: the case's identity and changes, the run that decided it,
-- and its rows in every table that has a column case_id (campaign/store/checksums.cc). Written with
-- the result; flipped bits, which SQLite does not notice, show as a difference.
CREATE TABLE result_checksums (
  case_id INTEGER PRIMARY KEY REFERENCES cases (id),
  checksum TEXT NOT NULL
) STRICT;

-- Of a campaign's cases with their parameters and changes, in order.
CREATE TABLE campaign_checksums (
  campaign_id INTEGER PRIMARY KEY REFERENCES campaigns (id),
  checksum TEXT NOT NULL
) STRICT;

-- The schema version whose columns the checksums cover: a migration that adds some has them made
-- anew, after what was there has been checked.
CREATE TABLE checksum_schema (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  version INTEGER NOT NULL
) STRICT;
INSERT INTO checksum_schema (id, version) VALUES (1, 0);
