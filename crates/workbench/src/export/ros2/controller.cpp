#include "@NAME@_controller.hpp"

#include <chrono>
#include <cmath>
#include <limits>

#include <pluginlib/class_list_macros.hpp>

namespace @NAME@_controller
{

using controller_interface::CallbackReturn;
using controller_interface::InterfaceConfiguration;
using controller_interface::interface_configuration_type;

namespace
{

constexpr double NO_NUMBER = std::numeric_limits<double>::quiet_NaN();

/// Value of a handle since Jazzy; not a number if there is none.
template<typename Handle>
auto value_of(const Handle & handle, int) -> decltype(handle.get_optional().value_or(0.0))
{
  return handle.get_optional().value_or(NO_NUMBER);
}

/// Value of a handle in Humble.
template<typename Handle>
double value_of(const Handle & handle, long)
{
  return handle.get_value();
}

}  // namespace

CallbackReturn Controller::on_init()
{
  auto_declare<std::string>("command_interface", "valve/voltage");
  for (const char * signal : SIGNALS) {
    auto_declare<std::string>(std::string(signal) + "_interface", "");
  }
  auto_declare<std::string>("reference_topic", "~/reference");
  return CallbackReturn::SUCCESS;
}

std::string Controller::parameter(const std::string & name) const
{
  return get_node()->get_parameter(name).as_string();
}

InterfaceConfiguration Controller::command_interface_configuration() const
{
  return {interface_configuration_type::INDIVIDUAL, {parameter("command_interface")}};
}

InterfaceConfiguration Controller::state_interface_configuration() const
{
  InterfaceConfiguration configuration{interface_configuration_type::INDIVIDUAL, {}};
  for (const char * signal : SIGNALS) {
    configuration.names.push_back(parameter(std::string(signal) + "_interface"));
  }
  return configuration;
}

CallbackReturn Controller::on_configure(const rclcpp_lifecycle::State &)
{
  const unsigned int rate = get_update_rate();
  if (rate != @RATE@U) {
    RCLCPP_ERROR(
      get_node()->get_logger(),
      "the controller was verified for @RATE@ samples per second, and update_rate is %u", rate);
    return CallbackReturn::FAILURE;
  }
  for (const char * signal : SIGNALS) {
    if (parameter(std::string(signal) + "_interface").empty()) {
      RCLCPP_ERROR(get_node()->get_logger(), "set the parameter %s_interface", signal);
      return CallbackReturn::FAILURE;
    }
  }
  reference_.writeFromNonRT({});
  subscription_ = get_node()->create_subscription<std_msgs::msg::Float64>(
    parameter("reference_topic"), rclcpp::SystemDefaultsQoS(),
    [this](const std_msgs::msg::Float64::SharedPtr message) {
      reference_.writeFromNonRT({true, message->data});
    });
  // the loop itself must not log
  timer_ = get_node()->create_wall_timer(std::chrono::seconds(1), [this]() {tell_invalid();});
  return CallbackReturn::SUCCESS;
}

CallbackReturn Controller::on_activate(const rclcpp_lifecycle::State &)
{
  if (command_interfaces_.empty()) {
    RCLCPP_ERROR(
      get_node()->get_logger(), "there is no command interface %s",
      parameter("command_interface").c_str());
    return CallbackReturn::ERROR;
  }
  for (std::size_t index = 0; index < COUNT; index++) {
    const std::string name = parameter(std::string(SIGNALS[index]) + "_interface");
    places_[index] = state_interfaces_.size();
    for (std::size_t place = 0; place < state_interfaces_.size(); place++) {
      if (state_interfaces_[place].get_name() == name) {
        places_[index] = place;
      }
    }
    if (places_[index] == state_interfaces_.size()) {
      RCLCPP_ERROR(get_node()->get_logger(), "there is no state interface %s", name.c_str());
      return CallbackReturn::ERROR;
    }
  }
  held_reference_ = value_of(state_interfaces_[places_[0]], 0);
  if (!std::isfinite(held_reference_)) {
    RCLCPP_ERROR(get_node()->get_logger(), "the measurement is not a finite number");
    return CallbackReturn::ERROR;
  }
  reference_.writeFromNonRT({});
  const double present = value_of(command_interfaces_[0], 0);
  @NAME@_reset(&state_);
  const @NAME@_signals signals = read(held_reference_);
  @NAME@_hold(&state_, &signals, std::isfinite(present) ? present : 0.0);
  return CallbackReturn::SUCCESS;
}

CallbackReturn Controller::on_deactivate(const rclcpp_lifecycle::State &)
{
  tell_invalid();
  return CallbackReturn::SUCCESS;
}

@NAME@_signals Controller::read(double reference) const
{
  @NAME@_signals signals;
  signals.reference = reference;
@READ@  return signals;
}

controller_interface::return_type Controller::update(
  const rclcpp::Time &, const rclcpp::Duration &)
{
  const Reference asked = *reference_.readFromRT();
  const @NAME@_signals signals = read(asked.is_received ? asked.value : held_reference_);
  const @NAME@_output output = @NAME@_step(&state_, &signals);
  if (output.invalid != 0) {
    invalid_.fetch_add(1, std::memory_order_relaxed);
  }
  (void)command_interfaces_[0].set_value(output.command);
  return controller_interface::return_type::OK;
}

void Controller::tell_invalid()
{
  const unsigned long long invalid = invalid_.load(std::memory_order_relaxed);
  if (invalid != told_) {
    RCLCPP_ERROR(
      get_node()->get_logger(),
      "%llu samples had a signal that is not a finite number; the last command was repeated",
      invalid - told_);
    told_ = invalid;
  }
}

}  // namespace @NAME@_controller

PLUGINLIB_EXPORT_CLASS(
  @NAME@_controller::Controller, controller_interface::ControllerInterface)
