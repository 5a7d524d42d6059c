//! The program, driven as a user would: arguments and streams in, exit code, streams and files out.

mod beyond;
mod bidirectional;
mod budget;
mod common;
mod estimate;
mod exposure;
mod extensions;
mod info;
mod lawful_runs;
mod misread;
mod passes;
mod rays_in_cells;
mod recorded;
mod references;
mod refusals;
mod render;
mod render_refusals;
mod report;
mod scene_estimators;
mod shell;
mod surfaces;
mod sweeps;
mod tables;
mod verdicts;
mod virtual_lights;
mod vocabulary;
