# SPDX-License-Identifier: BSD-3-Clause
# Completion of morph-mesh for bash: commands, options, and the surfaces of the grid that is on the
# command line. All are asked from the program.
_morph_mesh()
{
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} file names
  case "$before" in
    --move | --fix | --slide | --free)
      for file in "${COMP_WORDS[@]:1}"; do
        if [ -e "$file" ]; then
          # Names may have spaces; columns are two spaces apart.
          names=$("${COMP_WORDS[0]}" list "$file" 2> /dev/null | sed '1d; s/  .*//')
          mapfile -t COMPREPLY < <(IFS=$'\n'; compgen -W "$names" -- "$word" | sed 's/ /\\ /g')
          return
        fi
      done ;;
  esac
  case "$word" in
    -*)
      names=$("${COMP_WORDS[0]}" --help | sed -n 's/^  \(--[a-z-]*\).*/\1/p')
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
