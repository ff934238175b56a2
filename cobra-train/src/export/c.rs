//! A template as a C header.

use super::{Identifier, facts, lines};
use cobra_infer::{Template, TemplateError};

/// How each compiler is told to align to four bytes, in order of preference; one that is told
/// nothing reads the template all the same.
const ALIGNMENT: &str = "\
#ifndef COBRA_ALIGNED
#if defined(__cplusplus) && __cplusplus >= 201103L
#define COBRA_ALIGNED alignas(4)
#elif defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
#define COBRA_ALIGNED _Alignas(4)
#elif defined(__GNUC__) || defined(__clang__)
#define COBRA_ALIGNED __attribute__((aligned(4)))
#elif defined(__ICCARM__) || defined(__ICCRISCV__)
#define COBRA_ALIGNED _Pragma(\"data_alignment=4\")
#else
#define COBRA_ALIGNED
#endif
#endif
";

/// A C header with the template in `bytes` as an array `NAME`, and its length as the macro
/// `NAME_SIZE`, the macro in capitals.
///
/// C99, C11 and C++ read it. The array is `static const`: the header is all there is to add to a
/// project, and every source file that uses the array has its own, so that it belongs into one.
/// Aligned to four bytes where `COBRA_ALIGNED` knows how to say so; a definition of it before the
/// header comes first. A template is read at any alignment: this keeps what is linked before it from
/// changing how long that takes.
///
/// # Errors
/// [`TemplateError`] where `bytes` are no template.
pub fn c_header(bytes: &[u8], name: &Identifier) -> Result<String, TemplateError> {
    let template = Template::from_bytes(bytes)?;
    let capitals = name.capitals();
    let length = bytes.len();
    let facts: String = facts(&template, length, "")
        .iter()
        .map(|fact| format!(" *   {fact}\n"))
        .collect();
    let lines: String = lines(bytes, "0x", ",")
        .map(|line| format!("    {line}\n"))
        .collect();
    Ok(format!(
        "/* Written by `cobra export`; changes here do not survive the next one.\n \
          *\n \
          * A template of COBRA:\n \
          *\n\
         {facts} \
          *\n \
          * Include it in one source file: each that uses the array has a copy of its own.\n \
          */\n\
         #ifndef {capitals}_H\n\
         #define {capitals}_H\n\
         \n\
         #include <stdint.h>\n\
         \n\
         {ALIGNMENT}\
         \n\
         #define {capitals}_SIZE {length}\n\
         \n\
         COBRA_ALIGNED\n\
         static const uint8_t {name}[{length}] = {{\n\
         {lines}\
         }};\n\
         \n\
         #endif\n"
    ))
}
