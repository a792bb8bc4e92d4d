//! The bench itself: its time, its lines and its faults, around a device that echoes.

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::InputPin;
use embedded_hal::spi::{Operation, SpiDevice};
use fingertip_drivers::converters::{Level, SimulatedBench, SimulatedDevice, WireFaults};

/// Answers each byte with what it counts, and keeps what it is sent. It converts every 10 µs.
#[derive(Debug, Default)]
struct Echo {
    heard: Vec<u8>,
    selected: u32,
    deselected: u32,
    now: u64,
    ready: bool,
}

impl SimulatedDevice for Echo {
    fn advance(&mut self, nanoseconds: u64) {
        self.ready |= (self.now + nanoseconds) / 10_000 > self.now / 10_000;
        self.now += nanoseconds;
    }

    fn select(&mut self) {
        self.selected += 1;
        self.heard.clear();
    }
    fn shift(&mut self, byte: u8) -> u8 {
        self.heard.push(byte);
        self.heard.len() as u8
    }
    fn deselect(&mut self) {
        self.deselected += 1;
    }
    fn is_ready(&self) -> bool {
        self.ready
    }
    fn conversions(&self) -> u64 {
        self.now / 10_000
    }
}

fn bench(faults: WireFaults) -> SimulatedBench<Echo> {
    SimulatedBench::new(Echo::default(), faults)
}

#[test]
fn every_kind_of_operation_passes_its_bytes_and_takes_its_time() {
    let bench = bench(WireFaults::default());
    let (mut read, mut both, mut short) = ([0; 2], [7, 8], [0; 1]);
    let mut operations = [
        Operation::Write(&[1, 2]),
        Operation::DelayNs(5000),
        Operation::Read(&mut read),
        Operation::TransferInPlace(&mut both),
        Operation::Transfer(&mut short, &[9, 10]),
    ];
    bench.spi().transaction(&mut operations).unwrap();
    assert_eq!((read, both, short), ([3, 4], [5, 6], [7]));
    let mut longer = [0; 3];
    assert_eq!(bench.with(|echo| echo.heard.clone()), [1, 2, 0, 0, 7, 8, 9, 10]);
    bench.spi().transfer(&mut longer, &[5]).unwrap();
    assert_eq!((longer, bench.with(|echo| echo.heard.clone())), ([1, 2, 3], vec![5, 0, 0]));
    // 0.8 µs a byte: eight of them, the delay, and three.
    assert_eq!((bench.now(), bench.with(|echo| echo.now)), (13_800, 13_800));
    assert_eq!(bench.with(|echo| (echo.selected, echo.deselected)), (2, 2));
    bench.delay().delay_us(3);
    bench.advance(200);
    assert_eq!((bench.now(), bench.with(|echo| echo.now)), (17_000, 17_000));
}

#[test]
fn one_bit_of_a_transaction_is_flipped_there_or_back() {
    for there in [true, false] {
        let faults = WireFaults { seed: 2, ..WireFaults::default() };
        let bench = bench(faults);
        let on = if there {
            WireFaults { request_flip: 0.5, ..faults }
        } else {
            WireFaults { answer_flip: 0.5, ..faults }
        };
        bench.set_faults(on);
        let (mut count, mut seen) = (0, [0; 3]);
        for _ in 0..2000 {
            let mut bytes = [0x55, 0xAA, 0x0F];
            bench
                .spi()
                .transaction(&mut [Operation::Write(&[]), Operation::TransferInPlace(&mut bytes)])
                .unwrap();
            let heard = bench.with(|echo| echo.heard.clone());
            let flipped: Vec<u8> = if there {
                assert_eq!(bytes, [1, 2, 3]);
                heard.iter().zip([0x55, 0xAA, 0x0F]).map(|(heard, sent)| heard ^ sent).collect()
            } else {
                assert_eq!(heard, [0x55, 0xAA, 0x0F]);
                bytes.iter().zip(1..).map(|(got, sent): (&u8, u8)| got ^ sent).collect()
            };
            let bits: u32 = flipped.iter().map(|byte| byte.count_ones()).sum();
            assert!(bits <= 1);
            count += u64::from(bits);
            seen.iter_mut().zip(&flipped).for_each(|(seen, flipped)| *seen |= flipped);
        }
        assert_eq!((bench.flips(), seen), (count, [0xFF; 3]));
        // Half of 2000, within five times the root of 500.
        assert!((888..=1112).contains(&count), "{count}");
    }
    // Nothing to flip, and no chance to.
    let bench = bench(WireFaults { request_flip: 1.0, answer_flip: 1.0, ..WireFaults::default() });
    bench.spi().transaction(&mut [Operation::DelayNs(10)]).unwrap();
    assert_eq!(bench.flips(), 0);
}

#[test]
fn stuck_lines_stay_where_they_are() {
    for (level, byte) in [(Level::Low, 0), (Level::High, 0xFF)] {
        let bench = bench(WireFaults { stuck_data: Some(level), ..WireFaults::default() });
        let mut bytes = [0; 2];
        bench.spi().read(&mut bytes).unwrap();
        assert_eq!(bytes, [byte; 2]);
        bench.set_faults(WireFaults { stuck_ready: Some(level), ..WireFaults::default() });
        for _ in 0..3 {
            assert_eq!(bench.ready().is_low().unwrap(), level == Level::Low);
            bench.advance(10_000);
        }
    }
}

#[test]
fn a_ready_that_is_lost_stays_so_until_the_next_conversion() {
    let bench = bench(WireFaults::default());
    let mut pin = bench.ready();
    assert!(pin.is_high().unwrap());
    bench.advance(10_000);
    assert!(pin.is_low().unwrap());
    bench.set_faults(WireFaults { lost_ready: 0.25, seed: 4, ..WireFaults::default() });
    let mut lost = 0;
    for _ in 0..2000 {
        bench.advance(10_000);
        let high = pin.is_high().unwrap();
        // Drawn once: it does not change while it is the same conversion.
        for _ in 0..5 {
            bench.advance(1);
            assert_eq!(pin.is_high().unwrap(), high);
        }
        bench.advance(10_000 - bench.now() % 10_000);
        bench.advance(5000);
        pin.is_high().unwrap();
        lost += u32::from(high);
    }
    // A quarter of 2000, within five times the root of 375.
    assert!((404..=596).contains(&lost), "{lost}");
}

#[test]
fn the_longer_side_of_a_transfer_may_be_hit() {
    let bench = bench(WireFaults { request_flip: 1.0, answer_flip: 1.0, ..WireFaults::default() });
    let mut read = [0; 3];
    bench.spi().transfer(&mut read, &[]).unwrap();
    let there: u32 = bench.with(|echo| echo.heard.iter().map(|byte| byte.count_ones()).sum());
    let back: u32 = read.iter().zip(1..).map(|(got, sent): (&u8, u8)| (got ^ sent).count_ones()).sum();
    assert_eq!((there, back, bench.flips()), (1, 1, 2));
    bench.spi().transfer(&mut [], &[0; 3]).unwrap();
    let there: u32 = bench.with(|echo| echo.heard.iter().map(|byte| byte.count_ones()).sum());
    assert_eq!((there, bench.flips()), (1, 4));
}

/// Asks to be polled again whenever it is not done, as an executor has to be told.
#[test]
fn a_delay_of_a_task_wakes_it() {
    use alloc::sync::Arc;
    use core::sync::atomic::{AtomicU32, Ordering};
    use core::task::{Context, Poll};
    struct Count(AtomicU32);
    impl alloc::task::Wake for Count {
        fn wake(self: Arc<Self>) {
            self.0.fetch_add(1, Ordering::Relaxed);
        }
    }
    let (bench, count) = (bench(WireFaults::default()), Arc::new(Count(AtomicU32::new(0))));
    let waker = Arc::clone(&count).into();
    let mut context = Context::from_waker(&waker);
    let mut delay = bench.delay();
    let mut waiting = core::pin::pin!(embedded_hal_async::delay::DelayNs::delay_ns(&mut delay, 2_500));
    for (wakes, now) in [(1, 1000), (2, 2000), (3, 2500)] {
        assert_eq!(waiting.as_mut().poll(&mut context), Poll::Pending);
        assert_eq!((count.0.load(Ordering::Relaxed), bench.now()), (wakes, now));
    }
    assert_eq!(waiting.as_mut().poll(&mut context), Poll::Ready(()));
    assert_eq!((count.0.load(Ordering::Relaxed), bench.now()), (3, 2500));
}
