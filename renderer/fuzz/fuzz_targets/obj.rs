#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| renderer_fuzz::obj(data));
