# Start-up file of ./rosbots shell: the user's own shell, with roscd and its completion on top.
# A shell that reads a script comes here by BASH_ENV, which must not reach the script's children.
unset BASH_ENV
if [[ $- == *i* && -r $HOME/.bashrc ]]; then
  rosbots_path=$PATH
  . "$HOME/.bashrc"
  PATH=$rosbots_path:$PATH
  unset rosbots_path
fi
. /usr/share/bash-completion/completions/rosbash
PS1="(rosbots) ${PS1:-\\w \\$ }"
