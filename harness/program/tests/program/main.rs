//! The program itself, as a shell runs it: signals, kills, streams. Signals are sent as on Unix.
#![cfg(unix)]

mod common;
mod interrupt;
mod killed;
mod streams;
