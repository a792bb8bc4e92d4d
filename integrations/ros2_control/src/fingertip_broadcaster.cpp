// A controller that reads the wrench of a force/torque sensor and publishes what the fingertip feels.
#include <atomic>
#include <chrono>
#include <controller_interface/controller_interface.hpp>
#include <fingertip_broadcaster/feeler.hpp>
#include <fingertip_msgs/msg/touch.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <pluginlib/class_list_macros.hpp>
#include <rclcpp/rclcpp.hpp>
#include <realtime_tools/realtime_publisher.hpp>
#include <std_srvs/srv/trigger.hpp>
#include <string>
#include <type_traits>

namespace fingertip_broadcaster {

using controller_interface::CallbackReturn;
using Message = fingertip_msgs::msg::Touch;
using Trigger = std_srvs::srv::Trigger;

/// The value of a state interface: newer releases give it as an optional.
template <typename Interface>
auto value_of(const Interface& interface, int) -> decltype(interface.get_optional().value_or(0.0)) {
    return interface.get_optional().value_or(std::numeric_limits<double>::quiet_NaN());
}
template <typename Interface>
double value_of(const Interface& interface, long) {
    return interface.get_value();
}

class FingertipBroadcaster : public controller_interface::ControllerInterface {
public:
    CallbackReturn on_init() override {
        auto_declare<std::string>("sensor_name", "");
        auto_declare<std::string>("frame_id", "");
        auto_declare<std::string>("scene", "");
        auto_declare<double>("zero_seconds", 1.0);
        return CallbackReturn::SUCCESS;
    }

    controller_interface::InterfaceConfiguration command_interface_configuration() const override {
        return {controller_interface::interface_configuration_type::NONE, {}};
    }

    controller_interface::InterfaceConfiguration state_interface_configuration() const override {
        controller_interface::InterfaceConfiguration wanted;
        wanted.type = controller_interface::interface_configuration_type::INDIVIDUAL;
        for (const char* name : {"force.x", "force.y", "force.z", "torque.x", "torque.y", "torque.z"})
            wanted.names.push_back(sensor_ + "/" + name);
        return wanted;
    }

    CallbackReturn on_configure(const rclcpp_lifecycle::State&) override {
        const auto node = get_node();
        sensor_ = node->get_parameter("sensor_name").as_string();
        const auto scene = node->get_parameter("scene").as_string();
        const double seconds = node->get_parameter("zero_seconds").as_double();
        if (sensor_.empty() || scene.empty() || !(seconds > 0.0)) {
            RCLCPP_ERROR(node->get_logger(), "sensor_name and scene are needed, and zero_seconds must be above 0");
            return CallbackReturn::ERROR;
        }
        auto feeler = Feeler::from_file(scene, seconds);
        if (!feeler) {
            RCLCPP_ERROR(node->get_logger(), "%s", feeler.error().message());
            return CallbackReturn::ERROR;
        }
        feeler_.emplace(std::move(*feeler));
        publisher_ = node->create_publisher<Message>("~/touch", rclcpp::SystemDefaultsQoS());
        realtime_ = std::make_unique<realtime_tools::RealtimePublisher<Message>>(publisher_);
        // Strings get their room here: in update() nothing is to allocate.
        realtime_->msg_.header.frame_id = node->get_parameter("frame_id").as_string();
        realtime_->msg_.status.reserve(64);
        const auto serve = [&](const char* name, std::atomic<bool>& flag, const char* said) {
            return node->create_service<Trigger>(name, [&flag, said](Trigger::Request::SharedPtr, Trigger::Response::SharedPtr to) {
                flag = true;
                to->success = true;
                to->message = said;
            });
        };
        tare_ = serve("~/tare", wants_zero_, "the zero is being taken: nothing may touch; the log says how it ends");
        reset_ = serve("~/reset", wants_reset_, "the last contact and what detectors saw are forgotten");
        return CallbackReturn::SUCCESS;
    }

    CallbackReturn on_activate(const rclcpp_lifecycle::State&) override {
        if (state_interfaces_.size() != 6) {
            RCLCPP_ERROR(get_node()->get_logger(), "the sensor %s does not have all of force.x to torque.z", sensor_.c_str());
            return CallbackReturn::ERROR;
        }
        feeler_->start_anew();
        number_ = 0;
        return CallbackReturn::SUCCESS;
    }

    CallbackReturn on_deactivate(const rclcpp_lifecycle::State&) override { return CallbackReturn::SUCCESS; }

    controller_interface::return_type update(const rclcpp::Time& time, const rclcpp::Duration& period) override {
        if (wants_zero_.exchange(false)) feeler_->begin_zero();
        if (wants_reset_.exchange(false)) feeler_->start_anew();
        std::array<double, 6> wrench;
        for (std::size_t axis = 0; axis < wrench.size(); ++axis) wrench[axis] = value_of(state_interfaces_[axis], 0);
        const Zero before = feeler_->zero();
        const auto touch = feeler_->update(wrench, period.seconds());
        if (before == Zero::resting && feeler_->zero() == Zero::failed)
            RCLCPP_WARN(get_node()->get_logger(), "no new zero: the sensor gave no numbers; the one before is kept");
        // Counted whether it is sent or not, so that a gap shows.
        const std::uint64_t number = number_++;
        if (touch && realtime_->trylock()) {
            fill(realtime_->msg_, *touch, number, time);
            realtime_->unlockAndPublish();
        }
        return controller_interface::return_type::OK;
    }

private:
    static void fill(Message& to, const fingertip::Touch& touch, std::uint64_t number, const rclcpp::Time& time) {
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        const auto set = [](auto& vector, double x, double y, double z) {
            vector.x = x;
            vector.y = y;
            vector.z = z;
        };
        const auto contact = touch.contact();
        const auto part = [&](const fingertip::Vector fingertip::Contact::* of, std::size_t axis) {
            return contact ? ((*contact).*of)[axis] : none;
        };
        to.header.stamp = time;
        to.number = number;
        to.time = time.seconds();
        to.status = word(touch.resolution);
        set(to.load.force, touch.wrench.force[0], touch.wrench.force[1], touch.wrench.force[2]);
        set(to.load.torque, touch.wrench.torque[0], touch.wrench.torque[1], touch.wrench.torque[2]);
        using Contact = fingertip::Contact;
        set(to.point, part(&Contact::point, 0), part(&Contact::point, 1), part(&Contact::point, 2));
        set(to.normal, part(&Contact::normal, 0), part(&Contact::normal, 1), part(&Contact::normal, 2));
        set(to.tangential_force, part(&Contact::tangential_force, 0), part(&Contact::tangential_force, 1),
            part(&Contact::tangential_force, 2));
        to.normal_force = contact ? contact->normal_force : none;
        to.spin_torque = contact ? contact->spin_torque : none;
        const auto margin = touch.slip_margin();
        to.margin = margin ? margin->newtons : none;
        to.utilisation = margin ? margin->utilisation : none;
        // One more than the number of the library, whose first one also means that there is no detector.
        to.slip = static_cast<std::uint8_t>(touch.slip) + 1;
    }

    std::string sensor_;
    std::optional<Feeler> feeler_;
    std::uint64_t number_ = 0;
    std::atomic<bool> wants_zero_{false};
    std::atomic<bool> wants_reset_{false};
    rclcpp::Publisher<Message>::SharedPtr publisher_;
    std::unique_ptr<realtime_tools::RealtimePublisher<Message>> realtime_;
    rclcpp::Service<Trigger>::SharedPtr tare_;
    rclcpp::Service<Trigger>::SharedPtr reset_;
};

}  // namespace fingertip_broadcaster

PLUGINLIB_EXPORT_CLASS(fingertip_broadcaster::FingertipBroadcaster, controller_interface::ControllerInterface)
