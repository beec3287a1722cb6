#ifndef @GUARD@_CONTROLLER_HPP
#define @GUARD@_CONTROLLER_HPP

#include <array>
#include <atomic>
#include <cstddef>
#include <string>

#include <controller_interface/controller_interface.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_lifecycle/state.hpp>
#if __has_include(<realtime_tools/realtime_buffer.hpp>)
#include <realtime_tools/realtime_buffer.hpp>
#else
#include <realtime_tools/realtime_buffer.h>
#endif
#include <std_msgs/msg/float64.hpp>

#include "@NAME@.h"

namespace @NAME@_controller
{

/// The verified controller behind the interfaces of ros2_control.
class Controller : public controller_interface::ControllerInterface
{
public:
  controller_interface::CallbackReturn on_init() override;
  controller_interface::InterfaceConfiguration command_interface_configuration() const override;
  controller_interface::InterfaceConfiguration state_interface_configuration() const override;
  controller_interface::CallbackReturn on_configure(const rclcpp_lifecycle::State & state) override;
  controller_interface::CallbackReturn on_activate(const rclcpp_lifecycle::State & state) override;
  controller_interface::CallbackReturn on_deactivate(const rclcpp_lifecycle::State & state) override;
  controller_interface::return_type update(
    const rclcpp::Time & time, const rclcpp::Duration & period) override;

private:
  /// Signals after the reference, in the order of `SIGNALS`.
  static constexpr std::size_t COUNT = @COUNT@;
  static constexpr std::array<const char *, COUNT> SIGNALS = {{@SIGNALS@}};

  /// Last message since the activation, if there is one.
  struct Reference
  {
    bool is_received = false;
    double value = 0.0;
  };

  std::string parameter(const std::string & name) const;
  @NAME@_signals read(double reference) const;
  void tell_invalid();

  std::array<std::size_t, COUNT> places_{};
  @NAME@_state state_{};
  /// Reference until the first message after the activation: the measured value at that time.
  double held_reference_ = 0.0;
  realtime_tools::RealtimeBuffer<Reference> reference_;
  std::atomic<unsigned long long> invalid_{0};
  unsigned long long told_ = 0;
  rclcpp::Subscription<std_msgs::msg::Float64>::SharedPtr subscription_;
  rclcpp::TimerBase::SharedPtr timer_;
};

}  // namespace @NAME@_controller

#endif
