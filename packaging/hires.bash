# Completion of `hires` for bash: verbs and options are what the program's own help says.
_hires() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} verb='' candidates
  local i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    if [[ ${COMP_WORDS[i]} != -* ]]; then
      verb=${COMP_WORDS[i]}
      break
    fi
  done
  COMPREPLY=()
  if [ -z "$verb" ]; then
    # Verbs stand two columns in, below "Subcommands:".
    candidates="--help $(hires --help 2>/dev/null | sed -n '/^Subcommands:/,$s/^  \([a-z_]*\) .*/\1/p')"
  elif [[ $word == -* ]]; then
    candidates=$(hires "$verb" --help 2>/dev/null | grep -o -e '--[a-z][a-z-]*' | sort -u)
  elif [ "$verb" = list ] && [ "$before" = list ]; then
    candidates='areas objects actions motion_sets postures robots worlds scenarios tasks truths'
  else
    return 0  # names of files, by -o default
  fi
  # shellcheck disable=SC2207
  COMPREPLY=($(compgen -W "$candidates" -- "$word"))
}
complete -o default -F _hires hires
