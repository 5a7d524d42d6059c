//! Validates the WGSL port, and writes it as SPIR-V, GLSL, HLSL and MSL.
//!
//!     cargo run --manifest-path tests/ports/shaders/Cargo.toml -- FOLDER
//!
//! The library fairflight.wgsl is no shader by itself: it is validated and written with each of the other files beside it, which declare its field
//! and its variates. Where spirv-val and glslangValidator are installed they check what was written; of HLSL and MSL there is no such program for
//! every machine.

use naga::back::{glsl, hlsl, msl, spv};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, ResourceBinding, ShaderStage};
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// A part of this program that failed, in words.
type Failure = Box<dyn Error>;

fn main() -> ExitCode {
    let Some(out) = std::env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("usage: fairflight-shaders FOLDER");
        return ExitCode::from(2);
    };
    match run(&out) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{failure}");
            ExitCode::FAILURE
        }
    }
}

fn run(out: &Path) -> Result<(), Failure> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../wgsl");
    let library = folder.join("fairflight.wgsl");
    let mut files: Vec<PathBuf> =
        fs::read_dir(&folder)?.map(|entry| Ok(entry?.path())).collect::<Result<_, Failure>>()?;
    files.retain(|path| path.extension().is_some_and(|extension| extension == "wgsl") && *path != library);
    files.sort();
    fs::create_dir_all(out)?;
    let library = fs::read_to_string(library)?;
    for path in files {
        let source = format!("{library}\n{}", fs::read_to_string(&path)?);
        let name = path.file_stem().ok_or("a file of shaders has a name")?.to_string_lossy().into_owned();
        translate(&name, &source, out)?;
    }
    Ok(())
}

/// A shader in all languages, each in a file of `out`.
fn translate(name: &str, source: &str, out: &Path) -> Result<(), Failure> {
    let module = naga::front::wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    // What every device has: no f64, no subgroups, nothing that must be asked for.
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(&module).map_err(|error| error.emit_to_string(source))?;
    let entry = module.entry_points.first().ok_or("a shader has an entry point")?.name.clone();
    let file = |extension: &str| out.join(format!("{name}.{extension}"));

    let words = spv::write_vec(&module, &info, &spv::Options::default(), None)?;
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    fs::write(file("spv"), bytes)?;
    // Storage buffers with names of their own, as Vulkan and OpenGL 4.5 take them.
    fs::write(file("comp"), in_glsl(&module, &info, &entry)?)?;
    let mut text = String::new();
    let (options, pipeline) = (hlsl::Options::default(), hlsl::PipelineOptions::default());
    hlsl::Writer::new(&mut text, &options, &pipeline).write(&module, &info, None)?;
    fs::write(file("hlsl"), text)?;
    fs::write(file("metal"), in_msl(&module, &info, &entry)?)?;

    println!("{name}: valid; written as SPIR-V, GLSL, HLSL and MSL");
    check("spirv-val", &["--target-env", "vulkan1.1"], &file("spv"))?;
    check("glslangValidator", &["-V", "-S", "comp", "-o", "/dev/null"], &file("comp"))
}

/// The bindings of a module, in their order: a number for each.
fn bindings(module: &Module) -> impl Iterator<Item = (ResourceBinding, u8)> {
    let mut found: Vec<ResourceBinding> =
        module.global_variables.iter().filter_map(|(_, global)| global.binding).collect();
    found.sort();
    found.into_iter().zip(0..)
}

fn in_glsl(module: &Module, info: &ModuleInfo, entry: &str) -> Result<String, Failure> {
    let options = glsl::Options {
        version: glsl::Version::Desktop(450),
        binding_map: bindings(module).collect(),
        ..glsl::Options::default()
    };
    let pipeline = glsl::PipelineOptions {
        shader_stage: ShaderStage::Compute,
        entry_point: entry.to_owned(),
        multiview: None,
    };
    let mut text = String::new();
    let policies = naga::proc::BoundsCheckPolicies::default();
    glsl::Writer::new(&mut text, module, info, &options, &pipeline, policies)?.write()?;
    Ok(text)
}

fn in_msl(module: &Module, info: &ModuleInfo, entry: &str) -> Result<String, Failure> {
    let buffer = |(binding, slot): (ResourceBinding, u8)| {
        (binding, msl::BindTarget { buffer: Some(slot), mutable: true, ..msl::BindTarget::default() })
    };
    let resources: msl::BindingMap = bindings(module).map(buffer).collect();
    // Lengths of arrays stand in a buffer behind the others.
    let sizes_buffer = u8::try_from(resources.len()).ok();
    let resources =
        msl::EntryPointResources { resources, sizes_buffer, ..msl::EntryPointResources::default() };
    let options = msl::Options {
        lang_version: (2, 0),
        per_entry_point_map: [(entry.to_owned(), resources)].into(),
        ..msl::Options::default()
    };
    let (text, _) = msl::write_string(module, info, &options, &msl::PipelineOptions::default())?;
    Ok(text)
}

/// Runs a program that checks a file, where it is installed.
fn check(program: &str, arguments: &[&str], file: &Path) -> Result<(), Failure> {
    let found = match Command::new(program).args(arguments).arg(file).output() {
        Ok(found) => found,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            println!("  {program}: not installed, not asked");
            return Ok(());
        }
        Err(error) => return Err(error.into()),
    };
    if !found.status.success() {
        let told = [found.stdout, found.stderr].concat();
        return Err(
            format!("{program} refuses {}:\n{}", file.display(), String::from_utf8_lossy(&told)).into()
        );
    }
    println!("  {program}: passes");
    Ok(())
}
