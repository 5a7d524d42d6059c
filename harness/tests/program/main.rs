//! The program, driven as a user would: arguments and streams in, exit code, streams and files out.

mod beyond;
mod budget;
mod common;
mod estimate;
mod info;
mod lawful_runs;
mod passes;
mod rays_in_cells;
mod references;
mod refusals;
mod render;
mod render_refusals;
mod report;
mod scene_estimators;
mod surfaces;
mod verdicts;
mod virtual_lights;
mod vocabulary;
