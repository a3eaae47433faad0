//! The exit codes, as the help of the program and of its commands states them.

pub(super) const EXIT_CODES: &str = "Exit codes:
  0    done
  1    something went wrong while processing or writing
  2    wrong use or wrong input: usage, an unreadable file, a parameter out of range;
       `detect`, `floor`, `inspect` and `noise` do the good ones of many inputs all the same
  130  interrupted (Ctrl-C), 143 if it was told to end (SIGTERM); no file is left half written";
