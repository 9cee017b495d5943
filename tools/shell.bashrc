# Start-up file of ./rosbots shell: the user's own shell, with roscd and its completion on top.
# A shell that reads a script comes here by BASH_ENV, which must not reach the script's children.
unset BASH_ENV
if [[ $- == *i* && -r $HOME/.bashrc ]]; then
  . "$HOME/.bashrc"
  # A workspace that it sources has taken all others out of the environment.
  ROOT=$ROSBOTS_ROOT WORKSPACE=$(readlink -f "$ROSBOTS_ROOT/.ws")
  . "$ROOT/tools/environment.bash"
  enter_environment
  set +u
  unset ROOT WORKSPACE
fi
. /usr/share/bash-completion/completions/rosbash
PS1="(rosbots) ${PS1:-\\w \\$ }"
