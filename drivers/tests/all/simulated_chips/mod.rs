//! The simulated chips, spoken to in bytes as their data sheets have them, without the drivers.
#![cfg(all(
    feature = "ads131m",
    feature = "ads1256",
    feature = "hx711",
    feature = "mcp3564",
    feature = "nau7802",
    feature = "simulators"
))]

mod ads1256;
mod ads131m;
mod bench;
mod hx711;
mod mcp3564;
mod nau7802;

use fingertip_drivers::converters::SimulatedDevice;

/// One transaction: bytes there and back.
fn exchange(chip: &mut impl SimulatedDevice, bytes: &[u8]) -> Vec<u8> {
    chip.select();
    let answer = bytes.iter().map(|byte| chip.shift(*byte)).collect();
    chip.deselect();
    answer
}

/// A CRC of 16 bits, not reflected, bit by bit.
fn crc16(polynomial: u16, seed: u16, bytes: &[u8]) -> u16 {
    let mut crc = seed;
    for byte in bytes {
        crc ^= u16::from(*byte) << 8;
        for _ in 0..8 {
            crc = if crc >> 15 == 1 { crc << 1 ^ polynomial } else { crc << 1 };
        }
    }
    crc
}
