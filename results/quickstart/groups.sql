-- Per group of the campaign: how many cases slide, do not, cannot say so on their cells, and are UNEXPECTED.
SELECT parameter_labels ->> '$[0]' AS "group",
  count(*) AS cases,
  sum(activated AND rank_class = 0) AS slides,
  sum(NOT activated AND rank_class = 0) AS "does not",
  sum(rank_class <> 0) AS "hangs on the cells, ranked apart",
  sum(unexpected) AS UNEXPECTED
FROM ranking WHERE campaign = 'quickstart' GROUP BY 1 ORDER BY min("case");
