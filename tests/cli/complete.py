"""What a shell offers: complete.py bash|zsh FOLDER LINE..., the completion scripts' folder; for each line a line of what there is
to take at its end, sorted. The shell is a real one at a pseudo-terminal, and is asked as a person asks it."""
import os, pty, select, sys, tempfile, time

shell, folder, lines = sys.argv[1], os.path.abspath(sys.argv[2]), sys.argv[3:]
mark = os.path.join(tempfile.mkdtemp(), "offered")
environment = {"PATH": os.environ["PATH"], "HOME": os.path.dirname(mark), "TERM": "dumb", "LC_ALL": "C", "OFFERED": mark}

# bash puts all it would offer on the line (M-*) and runs that: a command of the tool's name writes down what it was given.
BASH = """PS1=; for f in %s/*; do . $f; name=${f##*/}
eval "$name() { shift \\$SHIFT; printf '%%s\\n' \\"\\$@\\" >$OFFERED.part; mv $OFFERED.part $OFFERED; }"; done
"""
# zsh is asked at compadd, where all that is offered goes by.
ZSH = """PS1= RPS1=; unsetopt zle_bracketed_paste prompt_cr prompt_sp; setopt no_list_beep
fpath=(%s $fpath); autoload -Uz compinit; compinit -u -D
compadd() { local -a hits; [[ " ${(j: :)@[1,(i)(-|--)]} " == *' -'[OAD]' '* ]] || { builtin compadd -A hits "$@"; print -rl -- $hits >>$OFFERED.part; }; builtin compadd "$@"; }
finish() { [[ -e $OFFERED.part ]] || : >$OFFERED.part; mv $OFFERED.part $OFFERED; }
ask() { comppostfuncs=(finish); zle complete-word; zle kill-whole-line; }
zle -N ask; bindkey '^T' ask
"""


def start():
    child, terminal = pty.fork()
    if child == 0:
        words = ["bash", "--norc", "--noprofile", "-i"] if shell == "bash" else ["zsh", "-f", "-i"]
        os.execvpe(words[0], words, environment)
    return terminal


def wait(terminal, path, seconds=180):
    """Until the file is there; what the shell echoes is read, and dropped."""
    end = time.time() + seconds
    said = b""
    while not os.path.exists(path):
        if time.time() > end:
            sys.exit("%s did not answer; it said %r" % (shell, said[-2000:]))
        if select.select([terminal], [], [], 0.02)[0]:
            said += os.read(terminal, 65536)


terminal = start()
setup = os.path.join(os.path.dirname(mark), "setup")
with open(setup, "w") as f:
    f.write((BASH if shell == "bash" else ZSH) % folder + ": >%s.ready\n" % mark)
os.write(terminal, (". %s\n" % setup).encode())
wait(terminal, mark + ".ready")
for line in lines:
    words = line.split(" ")
    if shell == "bash":
        # All but the word asked for is known, and left out; what is read by `<` is no word of the command. An empty line of answers is none.
        known = len(words) - 2 - 2 * words.count("<")
        os.write(terminal, ("SHIFT=%d; %s\x1b*\n" % (known, line)).encode())
    else:
        os.write(terminal, (line + "\x14").encode())
    wait(terminal, mark)
    with open(mark) as f:
        print(" ".join(sorted(set(w for w in f.read().split("\n") if w))))
    os.remove(mark)
