# Completion of faultsim and faultsweep for bash. It asks the program itself, so that it is never out of date.
_faultsim_complete() {
  local program=$1 word=$2 before=$3 command="" k
  for ((k = 1; k < COMP_CWORD; ++k)); do
    case ${COMP_WORDS[k]} in -*) ;; *) command=${COMP_WORDS[k]}; break ;; esac
  done
  local words=$command help
  [[ $command == init && ${COMP_WORDS[k + 1]} == from-grid ]] && words="init from-grid"
  help=$("$program" $words --help 2>/dev/null) || help=""
  case $before in
    --tier) COMPREPLY=($(compgen -W "screening demonstration standard reference custom" -- "$word")); return ;;
    --format) COMPREPLY=($(compgen -W "csv dakota salib" -- "$word")); return ;;
    --progress) COMPREPLY=($(compgen -W "none lines bar" -- "$word")); return ;;
  esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$(grep -oE -- '(^| |,)--?[a-zA-Z][a-z-]*' <<<"$help" | tr -d ' ,' | sort -u)" -- "$word"))
  elif [[ -z $command || $command == cache ]]; then
    COMPREPLY=($(compgen -W "$(awk '/^Subcommands:/ { on = 1; next } /^[^ ]/ { on = 0 } on && /^  [a-z]/ { print $1 }' <<<"$help")" -- "$word"))
  elif [[ $program == *faultsim && $command == init && $COMP_CWORD == 2 ]]; then
    COMPREPLY=($(compgen -W "field box from-grid" -- "$word"))
  else
    COMPREPLY=($(compgen -f -- "$word"))
  fi
}
complete -o filenames -F _faultsim_complete faultsim faultsweep
