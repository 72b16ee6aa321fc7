-- Migration 11: the views of rankings are made from the list of measures (views.sql), by this and
-- every later migration. A later measure's column is added by a migration that walks that list
-- (campaign/store/migrations.cc). The schema before it is store.sql, store_2.sql to store_10.sql.

DROP VIEW ranking;
DROP VIEW stage_ranking;
DROP VIEW fault_ranking;
