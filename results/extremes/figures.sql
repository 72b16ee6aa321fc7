-- What results/extremes/make found, as tables. :work is the folder of its diagnoses.
create temporary table d as
  select position, parameter_labels ->> '$[0]' as family,
         (select group_concat(json_extract(p.value, '$.name') || ' ' || l.value, ', ')
          from json_each(parameter_labels) l, json_each(c.parameters) p
          where p.key = l.key and l.value is not null and l.key > 0) as label,
         cast(trim(readfile(:work || '/case-' || position || '.code'), char(10)) as integer) as code,
         cast(readfile(:work || '/case-' || position || '.json') as text) as j,
         r.status, r.outcome, r.wall_s,
         (select max(open_area_m2) > 0 from chi_history h where h.case_id = cc.case_id) as opened
  from campaign_cases cc join case_labels using (campaign_id, position) join campaigns c on c.id = cc.campaign_id
       join runs r on r.id = (select run_id from cases where id = cc.case_id)
  where c.name = 'extremes';
update d set j = '{}' where not json_valid(j);
create temporary view v as
  select position, family, label, f.value ->> '$.what' as what, f.value ->> '$.told_by_result' as told
  from d, json_each(d.j, '$.violations') f;

select '# Extremes';
select '';
select 'Made by `results/extremes/make`: the campaign `extremes`, ' || count(*) || ' cases in plane strain.' from d;
select '';
select '* crashes: ' || sum(status = 'crashed' or code not in (0, 3, 5, 124)) || ', hangs: ' || sum(status = 'hung' or code = 124) ||
       ', other runs not completed: ' || sum(status not in ('completed', 'crashed', 'hung')) from d;
select '* diagnosed: ' || sum(j ->> '$.outcome' is not null) || '; same outcome as in the campaign: ' || sum(j ->> '$.outcome' = outcome) from d;
select '* load steps in equilibrium: ' || sum(j ->> '$.n_steps') || ', with equilibrium recomputed ' ||
       sum(j ->> '$.n_steps_with_equilibrium_recomputed') || ', with the flow rule checked ' ||
       sum(j ->> '$.n_steps_with_flow_rule_checked') from d;
select '* flagged cases: ' || count(distinct position) || '; **violations that the result does not tell: ' || coalesce(sum(not told), 0) || '**' from v;
select '';
select '| group | cases | converged | event | unresolved | no end | opens | residual | energy | asymmetry | condition | noise, full results | noise, unresolved | longest, s | flagged | untold |';
select '|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|';
select '| ' || family || ' | ' || count(*) || ' | ' || sum(outcome = 'converged') || ' | ' || sum(outcome = 'event') || ' | ' ||
       sum(outcome = 'unresolved_event') || ' | ' || sum(outcome in ('unconverged', 'unstable')) || ' | ' || sum(opened) || ' | ' ||
       printf('%.1e', max(j ->> '$.residual.worst')) || ' | ' || printf('%.1e', max(j ->> '$.energy.worst')) || ' | ' ||
       printf('%.1e', max(j ->> '$.operator.asymmetry')) || ' | ' || printf('%.1e', max(j ->> '$.operator.condition')) || ' | ' ||
       printf('%.1e', max(j ->> '$.noise.amplification') filter (where outcome in ('converged', 'event'))) || ' | ' ||
       iif(sum(outcome = 'unresolved_event') = 0, '–', printf('%.1e', max(j ->> '$.noise.amplification') filter (where outcome = 'unresolved_event'))) || ' | ' ||
       printf('%.1f', max(wall_s)) || ' | ' ||
       (select count(distinct position) from v where v.family = d.family) || ' | ' ||
       (select coalesce(sum(not told), 0) from v where v.family = d.family) || ' |'
from d group by family order by min(position);
select '';
select '## Flagged cases';
select '';
select '| case | group | values | flag | told by the result |';
select '|---|---|---|---|---|';
select '| ' || position || ' | ' || family || ' | ' || label || ' | ' || what || ' | ' || iif(told, 'yes', '**no**') || ' |' from v order by position;
