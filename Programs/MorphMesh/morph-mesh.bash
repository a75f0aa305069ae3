# SPDX-License-Identifier: BSD-3-Clause
# Completion of morph-mesh for bash: commands, options, and the surfaces and zones of the grid
# that is on the command line. All are asked from the program.
_morph_mesh()
{
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} file names=
  case "$before" in
    # Names may have spaces; columns are two spaces apart.
    --move | --fix | --slide | --free-surfaces) names='/^zone /d; 2,$s/  .*//p' ;;
    --fixed-zones | --rigid-zones | --soft-zones) names='s/^zone \(.*\): [0-9]* [a-z]*$/\1/p' ;;
  esac
  if [ -n "$names" ]; then
    for file in "${COMP_WORDS[@]:1}"; do
      if [ -e "$file" ]; then
        names=$("${COMP_WORDS[0]}" list "$file" 2> /dev/null | sed -n "$names")
        mapfile -t COMPREPLY < <(IFS=$'\n'; compgen -W "$names" -- "$word" | sed 's/ /\\ /g')
        return
      fi
    done
  fi
  case "$word" in
    -*)
      names=$("${COMP_WORDS[0]}" --help | sed -n 's/^  \(-[a-zA-Z], \)\{0,1\}\(--[a-z-]*\).*/\2/p')
      mapfile -t COMPREPLY < <(compgen -W "$names" -- "$word") ;;
    *)
      if [ "$COMP_CWORD" -eq 1 ]; then
        names=$("${COMP_WORDS[0]}" --help | sed -n '/^  [a-z]/s/^  \([a-z]*\) .*/\1/p')
        mapfile -t COMPREPLY < <(compgen -W "$names" -- "$word")
      fi
      compopt -o default 2> /dev/null ;;
  esac
}
complete -F _morph_mesh morph-mesh
