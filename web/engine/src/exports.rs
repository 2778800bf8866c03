//! Functions that the WebAssembly module exports to a page: one engine, a buffer for requests, and
//! one for answers.
//!
//! A page writes a request, and the bytes of a file after it, to the address that [`buffer`]
//! returns, calls [`answer`], and reads the answer at the address that [`answer_start`] returns.
//! Arrays are at the addresses of [`array_start`] until the next request. If the module traps,
//! [`fault_start`] is the address of the reason.

#![allow(unsafe_code)] // exported names are not mangled; no code here reads or writes through a pointer

use std::cell::RefCell;

use twintac_engine::{Array, Engine};

thread_local! {
    static ENGINE: RefCell<Engine> = RefCell::default();
    static BUFFER: RefCell<Vec<u8>> = RefCell::default();
    static ANSWER: RefCell<String> = RefCell::default();
    static FAULT: RefCell<String> = RefCell::default();
}

/// Reserves room for a request and the bytes after it, and returns its address.
#[unsafe(no_mangle)]
extern "C" fn buffer(length: usize) -> *mut u8 {
    BUFFER.with_borrow_mut(|buffer| {
        buffer.clear();
        buffer.resize(length, 0);
        buffer.as_mut_ptr()
    })
}

/// Answers the request in the first `request_length` bytes of the buffer, and returns the length of
/// the answer in bytes.
#[unsafe(no_mangle)]
extern "C" fn answer(request_length: usize) -> usize {
    std::panic::set_hook(Box::new(|fault| FAULT.set(fault.to_string())));
    let buffer = BUFFER.take();
    let (request, bytes) = buffer.split_at(request_length.min(buffer.len()));
    let request = String::from_utf8_lossy(request);
    let answer = ENGINE.with_borrow_mut(|engine| engine.answer(&request, bytes));
    let length = answer.len();
    ANSWER.set(answer);
    length
}

/// Address of the answer.
#[unsafe(no_mangle)]
extern "C" fn answer_start() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.as_ptr())
}

/// Number of entries of an array, four bytes each.
#[unsafe(no_mangle)]
extern "C" fn array_length(number: usize) -> usize {
    of_array(number, |start_and_length| start_and_length.1)
}

/// Address of an array.
#[unsafe(no_mangle)]
extern "C" fn array_start(number: usize) -> *const u8 {
    of_array(number, |start_and_length| start_and_length.0)
}

fn of_array<T>(number: usize, of: impl Fn((*const u8, usize)) -> T) -> T {
    ENGINE.with_borrow(|engine| {
        let Some(&array) = Array::ALL.get(number) else {
            return of((std::ptr::null(), 0));
        };
        let (indices, numbers) = (engine.arrays().indices(array), engine.arrays().numbers(array));
        if indices.is_empty() {
            of((numbers.as_ptr().cast(), numbers.len()))
        } else {
            of((indices.as_ptr().cast(), indices.len()))
        }
    })
}

/// Address of the text that says why the module trapped.
#[unsafe(no_mangle)]
extern "C" fn fault_start() -> *const u8 {
    FAULT.with_borrow(|fault| fault.as_ptr())
}

/// Length of that text in bytes.
#[unsafe(no_mangle)]
extern "C" fn fault_length() -> usize {
    FAULT.with_borrow(|fault| fault.len())
}
