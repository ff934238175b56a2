# cobra-infer with other features, and what it computes on other targets.

features() {
    sed -n '/^\[features\]/,/^all-kernels/s/^\([a-z-]*\) = \[\]$/\1/p' cobra-infer/Cargo.toml
}

# A kernel that was left out must take its functions with it: libm's are called by
# name, so that a library which does not name them does not link them.
links_only() {
    local library=$1 function=$2 expected=$3 found=no
    if grep -aq "libm.*[0-9]${function}" "$library"; then
        found=yes
    fi
    [ "$found" = "$expected" ] || {
        echo "$library: expected $function to be named: $expected" >&2
        return 1
    }
}

# Loads every golden template with the library as it was built last.
refuses_others_by_name() {
    local folder=$1 feature=$2 loader
    loader=$folder/loader
    rustc --edition 2024 --crate-name loader -o "$loader" -L "dependency=$folder/release/deps" \
        --extern "cobra_infer=$folder/release/libcobra_infer.rlib" - <<'END' || return
use cobra_infer::gp::UnitDirection;
use cobra_infer::{Template, TemplateError};
fn main() {
    let mut arguments = std::env::args().skip(1);
    let feature = arguments.next().expect("a feature");
    let mut loaded = 0;
    for path in arguments {
        let bytes = std::fs::read(&path).expect("a template");
        let right = match Template::from_bytes(&bytes) {
            Ok(template) => {
                loaded += 1;
                let component = template.components().next().expect("a component");
                let u = UnitDirection::new_unchecked([0.6, 0.0, 0.8].into());
                // A map asks for neither.
                let contained = template.has_maps()
                    || (template.kernel().feature() == feature
                        && template.metric().feature().is_none());
                contained
                    && component.posterior_mean(template.model(), &u).is_finite()
            }
            Err(TemplateError::KernelLeftOut { kernel }) => kernel.feature() != feature,
            Err(TemplateError::MetricLeftOut { metric }) => metric.feature().is_some(),
            Err(_) => false,
        };
        if !right {
            eprintln!("{path}: not what a build with {feature} alone should make of it");
            std::process::exit(1);
        }
    }
    if loaded == 0 && !["none", "angles"].contains(&feature.as_str()) {
        eprintln!("a build with {feature} loads no golden template");
        std::process::exit(1);
    }
}
END
    "$loader" "$feature" tests/golden/*.cobra
}

# The host's compiler is enough: which features a library has is no matter of target.
build_each_kernel_alone() {
    local feature wanted folder library
    folder=$target_dir/features
    for feature in none $(features); do
        wanted=${feature#none}
        cargo build --quiet --package cobra-infer --release --locked --no-default-features \
            --features "$wanted" --target-dir "$folder" || return
        library=$folder/release/libcobra_infer.rlib
        links_only "$library" powf "$([ "$feature" = rational-quadratic-free ] && echo yes || echo no)" &&
            links_only "$library" sinf "$([ "$feature" = periodic ] && echo yes || echo no)" &&
            links_only "$library" atan2f "$([ "$feature" = angles ] && echo yes || echo no)" &&
            refuses_others_by_name "$folder" "$feature" || return
    done
}

# `log` on this machine, where a test looks at the events. `defmt` needs a global logger to link, so that
# it is built as a library, for what it is meant for.
build_with_loggers() {
    local target=thumbv7em-none-eabihf
    cargo test --quiet --package cobra-infer --locked --features log --test log || return
    if need_cross "$target"; then
        cross "$target" core build --quiet --package cobra-infer --release --locked \
            --features defmt,log
    else
        skip "cobra-infer with defmt: no \`core\` for $target"
    fi
}

part_targets() {
    step "cobra-infer with each kernel alone"
    if build_each_kernel_alone; then
        pass
    else
        fail "cobra-infer with each kernel alone"
    fi
    step "cobra-infer with log and defmt"
    if build_with_loggers; then
        pass
    else
        fail "cobra-infer with log and defmt"
    fi
    compare_bits
}
