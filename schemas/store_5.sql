-- Migration 5: rows of designs. The schema before it is store.sql, store_2.sql to store_4.sql.

-- Which case each row of a design became. Rows that are the same case share one position, so that
-- statistics over the rows of a design (Sobol' indices, elementary effects) find all of them. Kept
-- of all designs of a campaign if one of them is sampled (latin-hypercube, sobol, morris, nested
-- with these) or rows were merged; of other campaigns not: there the cases, by position, are the rows.
-- Rows that were excluded are missing.
CREATE TABLE design_rows (
  campaign_id INTEGER NOT NULL REFERENCES campaigns (id),
  design INTEGER NOT NULL,             -- from 0: index in groups of campaigns.spec_resolved
  row INTEGER NOT NULL,                -- from 1, in the order of the design
  position INTEGER NOT NULL,           -- of the case in the campaign
  PRIMARY KEY (campaign_id, design, row),
  FOREIGN KEY (campaign_id, position) REFERENCES campaign_cases (campaign_id, position)
) STRICT, WITHOUT ROWID;
