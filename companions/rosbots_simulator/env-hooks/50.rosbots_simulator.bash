# roscd and the like; Debian leaves them to the completion of commands, which comes too late.
if [ -r /usr/share/bash-completion/completions/rosbash ]; then
  . /usr/share/bash-completion/completions/rosbash
fi
