-- Migration 16: how exact a result is. The schema before it is store.sql, store_2.sql to
-- store_15.sql. Of results stored before it is not known.

-- The surface of operators that a case's operator was interpolated on, and its largest relative
-- errors at check points; an exact operator has no row.
CREATE TABLE case_surfaces (
  case_id INTEGER PRIMARY KEY REFERENCES cases (id),
  operators INTEGER NOT NULL,          -- exact ones: its nodes
  basis INTEGER NOT NULL,              -- columns that are left of them
  checks INTEGER NOT NULL,             -- check points, none of them a node
  tolerance REAL NOT NULL,             -- that was asked for
  error_of_stiffness REAL NOT NULL,    -- of H, in the Frobenius norm
  error_of_traction REAL NOT NULL,     -- of the worst locked traction
  error_of_observation REAL NOT NULL,  -- of observation rows; 0 without
  error_of_slip REAL NOT NULL          -- of slip without friction under the worst load
) STRICT;

-- Share of the compartments' volume that the flow result covers; NULL without one.
ALTER TABLE case_metrics ADD COLUMN field_coverage REAL;
